/// Everything that programs need to load, make and render scenes. The headers named here are the public ones;
/// cmake --install also installs the headers that they include (docs/building.md).
#pragma once

#include "tandem/backends/make_backend.h"
#include "tandem/base/error.h"
#include "tandem/base/version.h"
#include "tandem/compile/prepare.h"
#include "tandem/effects/names.h"
#include "tandem/film/film.h"
#include "tandem/gltf/load_scene.h"
#include "tandem/images/compare.h"
#include "tandem/images/denoiser.h"
#include "tandem/images/image_io.h"
#include "tandem/images/tone_curve.h"
#include "tandem/render/adaptive_frame.h"
#include "tandem/render/checkpointed_frame.h"
#include "tandem/render/combined_backend.h"
#include "tandem/render/forecast.h"
#include "tandem/render/motion_blur.h"
#include "tandem/scene/named_scenes.h"
#include "tandem/scene/scene.h"
