/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "handlers.h"

#define RETI_CYCLES 4 /* simavr reports `reti` before it counts these cycles */

uint64_t handlers_cycles(const struct handlers *handlers)
{
	uint64_t running_cycles = handlers->avr->cycle - handlers->running_since;
	return handlers->finished_cycles + (handlers->depth ? running_cycles : 0);
}

/* Adds the cycles since `running_since` to the innermost handler. */
static void account_cycles(struct handlers *handlers, uint64_t cycle)
{
	if (handlers->depth) {
		uint64_t spent_cycles = cycle - handlers->running_since;
		handlers->finished_cycles += spent_cycles;
		handlers->vectors[handlers->running_vectors[handlers->depth - 1]].cycles += spent_cycles;
	}
	handlers->running_since = cycle;
}

static void on_vector(struct avr_irq_t *irq, uint32_t is_running, void *param)
{
	struct handlers *handlers = param;
	uint8_t vector = irq->irq / 256; /* simavr numbers the irqs of vector v from 256 v on */
	account_cycles(handlers, handlers->avr->cycle + (is_running ? 0 : RETI_CYCLES));
	if (!is_running) {
		if (handlers->depth)
			handlers->depth--;
	} else if (vector < CHIP_VECTOR_COUNT && handlers->depth < sizeof handlers->running_vectors) {
		handlers->vectors[vector].vector = vector;
		handlers->vectors[vector].entry_count++;
		handlers->running_vectors[handlers->depth++] = vector;
	}
}

void handlers_attach(struct handlers *handlers, avr_t *avr)
{
	*handlers = (struct handlers){ .avr = avr };
	for (int v = 0; v < avr->interrupts.vector_count; v++)
		avr_irq_register_notify(
			avr->interrupts.vector[v]->irq + AVR_INT_IRQ_RUNNING, on_vector,
			handlers);
}
