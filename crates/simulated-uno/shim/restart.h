/* Executes resets and power cuts between two instructions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "board.h"

/* Resets the chip now. `causes`: bits of enum reset_cause; if 0, the reset is not
 * recorded. */
void restart(struct uno *uno, uint8_t causes);
/* Executes the reset or power cut that a part of the board has requested. Returns false if none is
 * requested. */
bool restart_if_requested(struct uno *uno);
/* To be called while the supply holds the chip in reset: advances the clock to the next of simavr's
 * cycle timers or to cycle `until`, whichever comes first. */
void restart_advance_in_reset(struct uno *uno, uint64_t until);
/* Switches the power off: nothing runs until the power is restored. */
void restart_cut_power(struct uno *uno);
/* Advances simavr's clock to the current cycle; must be called before the board is changed from
 * outside. */
void restart_catch_up(struct uno *uno);
