#include "layouts.h"

namespace spherical_springs {

const TypeLayout* layoutsOfLibrary() { return kLayouts; }

}  // namespace spherical_springs
