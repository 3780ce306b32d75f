/* Carries out resets and power cuts, between two instructions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "board.h"

/* Resets the chip now; `cause` is one or more of enum reset_cause. */
void restart(struct uno *uno, uint8_t cause);
/* Carries out the reset or power cut that a part has requested. True if there was one. */
bool restart_if_asked(struct uno *uno);
/* The supply holds the chip in reset: time passes, nothing else. */
bool restart_wait(struct uno *uno, uint64_t until);
/* `normal`: simavr's run callback before its watchdog changed it. */
void restart_by_stock_watchdog(struct uno *uno, avr_run_t normal);
/* From now on nothing runs until the power is restored. */
void restart_cut_power(struct uno *uno);
/* Advances simavr's clock to the time reached, before the board is changed from outside. */
void restart_catch_up(struct uno *uno);
