/* Timer1's 16-bit registers according to the data sheet (16.3): a high byte is read and written
 * through the shared byte TEMP. simavr 1.6 stores a high byte at once.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

struct timer1 {
	uint8_t temp;                         /* TEMP */
	struct write_hook stock_low_hooks[4]; /* simavr's callbacks for the low bytes */
	struct read_hook stock_count_hook;    /* simavr's callback for TCNT1L */
};

void timer1_attach(struct timer1 *timer1, avr_t *avr);
void timer1_reset(struct timer1 *timer1);
