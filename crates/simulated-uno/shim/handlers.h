/* Statistics of interrupts: the number of times that each is served, and the cycles of its handler.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

struct vector_stats {
	uint8_t vector;       /* number of the vector, counted from 0 (reset) */
	uint64_t entry_count; /* number of times that the interrupt was served */
	uint64_t cycles;      /* cycles spent in its handler */
};

struct handlers {
	const avr_t *avr;
	struct vector_stats vectors[CHIP_VECTOR_COUNT];
	uint8_t running_vectors[16]; /* vector numbers of the nested handlers, innermost last */
	uint8_t depth;               /* number of nested handlers; 0 while the main program runs */
	uint64_t running_since;      /* cycle at which the innermost handler started or resumed */
	uint64_t finished_cycles;    /* cycles spent in handlers up to `running_since` */
};

void handlers_attach(struct handlers *handlers, avr_t *avr);
/* The cycles spent in all handlers so far. */
uint64_t handlers_cycles(const struct handlers *handlers);
