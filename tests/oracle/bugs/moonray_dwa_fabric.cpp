// bugs/moonray_dwa_fabric.cpp  OpenMoonRay: samples halve an angle, the pdf has half vectors
//
// source: dreamworksanimation/moonray 6f49185999c634d4797713d0731ee6c5d9af8af6 lib/rendering/shading/bsdf/fabric/BsdfDwaFabric.cc
// cut: /^DwaFabricBsdfLobe::eval(/,/^}/
// cut: /^DwaFabricBsdfLobe::sampleVector(/,/^}/
// C++: s/^DwaFabricBsdfLobe::eval/Color Lobe::eval/; s/^DwaFabricBsdfLobe::sample/void Lobe::sample/
// C++: s/scene_rdl2::math:://g
// repair: s/\*pdf = \(mSpecularExponent\+1\.0f\).*/*pdf = pdf_of_angles(*this, slice.getWo(), wi);/; s/\*pdf \*= 0\.25 \* rcp\(cosHWo\);//
// repair: s/if \(r2 < 0\.5f\) thetaH \*= -1\.0f;/if (r2 < 0.5f) thetaH *= -1.0f, r2 *= 2; else r2 = 2 * r2 - 1;/
#include "moonray.h"
// thetaI = 2 thetaH - thetaO, 1 - |sin thetaH| has the density (n+1) s^n, phi is uniform on (0,
// pi).
inline float pdf_of_angles(const Lobe& lobe, Vec3f wo, Vec3f wi) {
    const double sine = dot(lobe.mThreadDirection, wi), n = lobe.mSpecularExponent,
                 theta_h = (asin(dot(lobe.mThreadDirection, wo)) + asin(sine)) / 2;
    return (n + 1) / (4 * sPi) * pow(1 - fabs(sin(theta_h)), n) * cos(theta_h) /
           sqrt(std::max(1 - sine * sine, 1e-6));
}
#include "excerpt.h"

int main() { return answer_fabric({.mSpecularExponent = 20}, "DWA fabric"); }
