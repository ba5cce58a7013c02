#pragma once

namespace relative_map {

/// Waits for a master, and says so if there is none. roscpp's own waiting can't be interrupted: this can, by
/// any signal that ends a process, as long as no node handle was made before.
void wait_for_master();

}  // namespace relative_map
