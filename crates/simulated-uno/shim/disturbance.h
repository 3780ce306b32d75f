/* Disturbances of the CPU that a test imposes: a foreign interrupt, which has the highest
 * priority and no source on the chip, and a main program that makes no progress.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "handlers.h"

struct disturbance {
	avr_t *avr;
	const struct handlers *handlers;
	uint64_t foreign_cycles_left; /* rest of the foreign interrupt; 0 if none is pending */
	uint64_t stalled_until;       /* the main program executes nothing before this cycle */
};

/* Serves the foreign interrupt if it is pending and interrupts are enabled: its cycles pass
 * without an instruction, while timers and the serial line continue and set their flags. Must be
 * called before the chip's interrupts are served. */
void disturbance_serve(struct disturbance *disturbance);
/* True while a disturbance is pending or in progress: simavr must then run one instruction at a
 * time. */
bool disturbance_is_active(const struct disturbance *disturbance);
/* True if the next instruction belongs to the main program and the main program is stalled. */
bool disturbance_stalls_main(const struct disturbance *disturbance);
/* Advances the clock to the next simavr timer, to `until` or to the end of the stall,
 * whichever comes first. */
void disturbance_advance_stall(struct disturbance *disturbance, uint64_t until);
