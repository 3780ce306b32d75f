/* Corrections to simavr 1.6's interrupt handling, to match the ATmega328P's data sheet.
 *
 * - Entering an interrupt takes 4 cycles, and 4 more from sleep (section 7.7.1).
 * - An enabled interrupt is served whenever its flag is set, even if it was enabled after the flag
 *   was set. After `sei`, one more instruction is executed first.
 * - Writing a one to a flag in TIFRn clears that flag and no other.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "instruction.h"

struct interrupts {
	const struct instruction *instruction;
	avr_t *avr;
	/* EE_READY has no flag: it is pending as long as the EEPROM is not busy. */
	const avr_int_vector_t *eeprom_ready;
	const bool *is_eeprom_busy;
	bool ends_sleep;  /* the next interrupt to be served wakes the CPU */
	bool needs_check; /* a flag or an enable bit has changed since the last check of all interrupts */
};

/* Takes over simavr's handling of interrupts. */
void interrupts_attach(struct interrupts *interrupts, const struct instruction *instruction);
/* Requests a check of all interrupts after the current instruction; must be called when a flag or
 * an enable bit has changed. */
void interrupts_request_check(struct interrupts *interrupts);
/* If interrupts are enabled, enters the handler of the pending interrupt with the highest priority.
 * Returns true if it has entered a handler, which takes cycles. */
bool interrupts_serve(struct interrupts *interrupts);
