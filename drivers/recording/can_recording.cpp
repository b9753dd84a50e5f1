// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/can_recording.hpp"
