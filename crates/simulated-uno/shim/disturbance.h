/* Disturbances of the processor by a test: an interrupt of no source on the chip, and a
 * main program that makes no progress.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "handlers.h"

struct disturbance {
	avr_t *avr;
	const struct handlers *handlers;
	uint64_t held;          /* cycles of a foreign interrupt that is pending */
	uint64_t stalled_until; /* main executes nothing before this cycle */
};

void disturbance_attach(struct disturbance *disturbance, avr_t *avr,
                        const struct handlers *handlers);
/* Serves the foreign interrupt if it is pending and interrupts are on: cycles pass in
 * which nothing is executed and flags are set. To be called before the chip's interrupts are served. */
void disturbance_serve(struct disturbance *disturbance);
/* True while a disturbance is pending or in progress; then simavr must run one instruction at
 * a time. */
bool disturbance_waits(const struct disturbance *disturbance);
/* True if the next instruction is main's and main is stopped. */
bool disturbance_stalls(const struct disturbance *disturbance);
/* Advances the time to the next event, to `until` or to the end of the stall. */
void disturbance_wait(struct disturbance *disturbance, uint64_t until);
