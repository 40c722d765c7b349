// All of validation, as one header; kept for programs written for penumbra 0.1.
#pragma once

#include "penumbra/compare.h"  // IWYU pragma: export
#include "penumbra/povray.h"   // IWYU pragma: export
#include "penumbra/report.h"   // IWYU pragma: export
