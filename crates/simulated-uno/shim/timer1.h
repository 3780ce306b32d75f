/* Timer1's 16-bit registers by the data sheet (16.3): a high byte goes through
 * TEMP, one byte that they all share. simavr 1.6 stores it at once.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

struct timer1 {
	uint8_t temp;
	struct write_hook write_low[4]; /* simavr's, which TEMP goes before */
	struct read_hook read_count;
};

void timer1_attach(struct timer1 *timer1, avr_t *avr);
void timer1_reset(struct timer1 *timer1);
