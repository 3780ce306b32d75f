/* What a test does to the processor that no firmware asks for: an interrupt out
 * of nowhere, and a main program that makes no progress.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "handlers.h"

struct disturbance {
	avr_t *avr;
	const struct handlers *handlers;
	uint64_t held;          /* cycles of a foreign interrupt that waits to be served */
	uint64_t stalled_until; /* main executes nothing before this cycle */
};

void disturbance_attach(struct disturbance *disturbance, avr_t *avr,
                        const struct handlers *handlers);
/* Serves the foreign interrupt if it waits and interrupts are on: cycles pass in
 * which nothing is executed and flags go up. Before all the chip's interrupts. */
void disturbance_serve(struct disturbance *disturbance);
/* Whether one of the two is under way, so that simavr must run one instruction at
 * a time. */
bool disturbance_waits(const struct disturbance *disturbance);
/* Whether the next instruction is main's, and main is not to make progress. */
bool disturbance_stalls(const struct disturbance *disturbance);
/* Passes the time to the next event, `until` or the end of the stall. */
void disturbance_wait(struct disturbance *disturbance, uint64_t until);
