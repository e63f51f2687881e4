#include "transcription/native.h"

namespace report {

void stepNatively(Scene& scene, double dt) { step(scene, dt); }

}  // namespace report
