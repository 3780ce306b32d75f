/* Corrections of simavr 1.6's interrupts by the ATmega328P's data sheet.
 *
 * - An interrupt takes 4 cycles to enter, 4 more from sleep (7.7.1).
 * - Interrupts are levels: an enabled one whose flag is set fires, whenever it
 *   was enabled, and one instruction after `sei`.
 * - A one written to TIFRn clears that flag and no other.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "instruction.h"

/* An interrupt without a flag: it is requested as long as its condition holds. */
struct level { const avr_int_vector_t *vector; bool up; };

struct interrupts {
	const struct instruction *instruction;
	avr_t *avr;
	struct level eeprom_ready;
	bool slept;   /* the next interrupt to be served ends a sleep */
	bool recheck; /* a flag or an enable bit changed: all must be checked */
};

void interrupts_attach(struct interrupts *interrupts, const struct instruction *instruction);
/* A flag or an enable bit has changed: checks all interrupts after the instruction being
 * executed. */
void interrupts_changed(struct interrupts *interrupts);
/* Serves the highest enabled interrupt. True if cycles passed. */
bool interrupts_serve(struct interrupts *interrupts);
