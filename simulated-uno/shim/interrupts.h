/* What simavr 1.6 gets wrong about interrupts, put right by the ATmega328P's
 * data sheet.
 *
 * - An interrupt takes 4 cycles to enter, 4 more from sleep (7.7.1).
 * - Interrupts are levels: an enabled one with its flag up fires, whenever it
 *   was enabled, and one instruction after `sei`.
 * - A one written to TIFRn clears that flag and no other.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef INTERRUPTS_H
#define INTERRUPTS_H

#include <stdbool.h>

#include <simavr/sim_avr.h>

#include "instruction.h"

struct interrupts {
	const struct instruction *instruction;
	avr_t *avr;
	bool slept;   /* the interrupt about to be served ends a sleep */
	bool recheck; /* a flag or an enable bit changed: look at all again */
};

void interrupts_attach(struct interrupts *interrupts, const struct instruction *instruction);
/* Serves the highest enabled interrupt. True if cycles passed. */
bool interrupts_serve(struct interrupts *interrupts);

#endif
