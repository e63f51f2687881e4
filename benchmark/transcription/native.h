// The report transcribed, compiled for this machine's processor.
#pragma once

#include "transcription/report.h"

namespace report {

void stepNatively(Scene& scene, double dt);

}  // namespace report
