/* The watchdog by the ATmega328P's data sheet, 11.8 and 11.9.2.
 *
 * simavr 1.6 never resets while the interrupt is enabled, restarts the counter
 * when its prescaler is changed, and clears WDIE in interrupt mode.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include <simavr/avr_watchdog.h>

#include "instruction.h"
#include "interrupts.h"
#include "reset.h"

struct watchdog {
	avr_io_t io;           /* our place in simavr's list: `wdr` comes to it */
	avr_t *avr;
	const struct instruction *instruction;
	struct interrupts *interrupts;
	struct reset *reset;
	avr_watchdog_t *stock; /* simavr's, for its interrupt vector */
	uint64_t since;        /* cycle at which the counter was zero */
	uint64_t change_until; /* last cycle of the timed sequence's window */
};

/* Replaces simavr's watchdog. */
void watchdog_attach(struct watchdog *watchdog, const struct instruction *instruction,
                     struct interrupts *interrupts, struct reset *reset);
/* After a reset: on if WDRF is set. */
void watchdog_reset(struct watchdog *watchdog);
/* True if it will reset the chip unless the firmware acts. */
bool watchdog_may_reset(const struct watchdog *watchdog);
