/* Timer1's 16-bit registers according to the data sheet (16.3): a high byte is read and written
 * through the shared byte TEMP. simavr 1.6 stores a high byte at once.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

/* The 16-bit registers TCNT1, ICR1, OCR1A and OCR1B, one after another from TCNT1L on. */
#define TIMER1_REGISTER_COUNT 4

struct timer1 {
	uint8_t temp; /* TEMP */
	/* simavr's callbacks for writes of the low bytes, and for reads of TCNT1L: */
	struct write_hook stock_low_hooks[TIMER1_REGISTER_COUNT];
	struct read_hook stock_count_hook;
};

void timer1_attach(struct timer1 *timer1, avr_t *avr);
