#include "penumbra/math.h"
