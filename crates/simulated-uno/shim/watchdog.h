/* The watchdog according to the ATmega328P's data sheet, 11.8 and 11.9.2.
 *
 * simavr 1.6 never resets the chip while the watchdog interrupt is enabled, restarts the counter when
 * the prescaler is changed, and clears WDIE in interrupt mode.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include <simavr/avr_watchdog.h>

#include "interrupts.h"
#include "reset.h"

struct watchdog {
	avr_io_t io;                /* our entry in simavr's list of parts, which receives `wdr` */
	struct interrupts *interrupts;
	struct reset *reset;
	avr_watchdog_t *stock;      /* simavr's watchdog, for its interrupt vector */
	uint64_t counter_start;     /* last cycle at which the counter was zero */
	uint64_t change_window_end; /* last cycle at which WDE and WDP may change, after WDCE is set */
};

/* Replaces simavr's watchdog. */
void watchdog_attach(struct watchdog *watchdog, struct interrupts *interrupts, struct reset *reset);
/* Switches the watchdog on if WDRF is set, otherwise off; must be called after a reset. */
void watchdog_reset(struct watchdog *watchdog);
/* True if the watchdog will reset the chip unless the firmware acts. */
bool watchdog_may_reset(const struct watchdog *watchdog);
