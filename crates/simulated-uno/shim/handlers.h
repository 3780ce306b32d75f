/* The number of times that each interrupt is served, and the cycles of its handler.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

struct vector_use { uint64_t entries, cycles; };

struct handlers {
	const avr_t *avr;
	struct vector_use vectors[CHIP_VECTORS];
	uint8_t running[16];    /* nested handlers, the innermost last */
	uint8_t depth;
	uint64_t running_since; /* cycle at which the innermost started or resumed */
	uint64_t finished;      /* cycles in handlers up to `running_since` */
};

void handlers_attach(struct handlers *handlers, avr_t *avr);
void handlers_reset(struct handlers *handlers);
/* Cycles spent in all handlers up to now. */
uint64_t handlers_cycles(const struct handlers *handlers);
