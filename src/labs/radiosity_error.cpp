// labs/radiosity_error.cpp  5  what build/radiosity --error delivers
//
//   build/radiosity_error [--quick]
#include "labs/calibration_maps.h"

int main(int argc, char** argv) {
    illumination::calibration::Extent extent;
    const Lab lab{"radiosity_error",
                  "Measures true errors of illumination maps over those asked for.",
                  {quick_flag(extent.quick)}};
    return lab_main(argc, argv, lab, [&] {
        Report report(report_folder(extent.quick), "radiosity-error");
        report.say(
            "# Illumination maps of a given error\n\nTrue errors of `build/radiosity "
            "--error E` over E, on all scenes of diffuse surfaces (cornell36b and "
            "cornell36obj are cornell36).  Errors leave out what the triangles cost.");
        illumination::calibration::tell_maps(report, extent);
        report.say(made_by(argc, argv));
        return report.finish();
    });
}
