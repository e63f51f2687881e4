#include "relax_mesh/map_here.h"

#include <cmath>

#include "base/available_threads.h"
#include "relax_mesh/interruption.h"
#include "relax_mesh/progress_line.h"

namespace spherical_springs::relax_mesh {

mesh::MeshMap mapHere(const Task& task, const Options& asked) {
  mesh::MapOptions options;
  options.angle_weight = asked.angle_weight;
  options.tolerance = asked.spread;
  options.max_time = timeFor(task, asked);
  options.threads = core::availableThreads();
  throwIfInterrupted();
  ProgressLine line;
  options.go_on = [&](const mesh::MapProgress& progress) {
    line.show(progress);
    if (!interrupted()) return true;
    if (std::isinf(progress.spread)) throw Interrupted();
    return false;
  };
  return mesh::meshMap(task.surface, task.shares, task.start, options);
}

}  // namespace spherical_springs::relax_mesh
