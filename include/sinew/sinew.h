// The whole public interface: of C++, and for a C compiler that of C.
#ifndef SINEW_SINEW_H
#define SINEW_SINEW_H

#include <sinew/capi.h>

#ifdef __cplusplus
#include <sinew/error.h>
#include <sinew/forceps.h>
#include <sinew/haptics.h>
#include <sinew/metrics.h>
#include <sinew/scene_builder.h>
#include <sinew/simulation.h>
#include <sinew/types.h>
#include <sinew/version.h>
#endif

#endif
