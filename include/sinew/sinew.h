// The whole public interface.
#pragma once

#include <sinew/error.h>
#include <sinew/scene_builder.h>
#include <sinew/simulation.h>
#include <sinew/types.h>
#include <sinew/version.h>
