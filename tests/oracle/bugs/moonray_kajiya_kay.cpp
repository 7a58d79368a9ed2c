// bugs/moonray_kajiya_kay.cpp  OpenMoonRay: one number chooses the side and the azimuth of a thread
//
// source: dreamworksanimation/moonray 6f49185999c634d4797713d0731ee6c5d9af8af6 lib/rendering/shading/bsdf/fabric/BsdfKajiyaKayFabric.cc
// cut: /^KajiyaKayFabricBsdfLobe::eval(/,/^}/
// cut: /^KajiyaKayFabricBsdfLobe::sampleVector(/,/^}/
// C++: s/^KajiyaKayFabricBsdfLobe::eval/Color Lobe::eval/; s/^KajiyaKay\w+::sample/void Lobe::sample/
// C++: s/scene_rdl2::math:://g; s/if \(fabricBRDF\/\(\*pdf\) > 4\)/if (false)/
// repair: s/if \(\(thetaD < thetaO\) && \(r2 < 0\.5\)\)/const bool minus = r2 < 0.5f; r2 = minus ? 2 * r2 : 2 * r2 - 1; if (thetaD < thetaO \&\& minus)/
#include "moonray.h"

#include "excerpt.h"

int main() {
    // Without the clamp of the pdf near the peak, a declared trade of bias for noise.
    return answer_fabric({.mSpecularExponent = 32}, "Kajiya and Kay");
}
