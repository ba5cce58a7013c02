#pragma once

#include <relative_map/RelativeMapConfig.h>

#include "relative_map/model/config.hpp"

namespace relative_map {

// What may be changed while driving (dynamic_reconfigure), in and out of the pipeline's configuration.

/// The part of a configuration that may be changed.
RelativeMapConfig reconfigure_view(core::PipelineConfig config);
/// The configuration with that part as requested; not validated yet.
core::PipelineConfig with_request(core::PipelineConfig config, RelativeMapConfig request);

}  // namespace relative_map
