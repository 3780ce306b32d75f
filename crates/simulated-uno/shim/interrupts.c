/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interrupts.h"

#include <simavr/sim_core.h>

#define ENTRY_CYCLES 4
#define WAKE_CYCLES 4

static bool is_pending(const struct interrupts *interrupts, const avr_int_vector_t *vector)
{
	avr_t *avr = interrupts->avr;
	if (!avr_regbit_get(avr, vector->enable))
		return false;
	if (vector == interrupts->eeprom_ready)
		return !*interrupts->is_eeprom_busy;
	return vector->raised.reg ? avr_regbit_get(avr, vector->raised) : vector->pending;
}

/* Rebuilds simavr's list of pending interrupts, which `sleep` checks, from the flags. Returns the
 * interrupt with the highest priority, or NULL if none is pending. */
static avr_int_vector_t *collect_pending(const struct interrupts *interrupts)
{
	avr_t *avr = interrupts->avr;
	avr_int_table_t *table = &avr->interrupts;
	avr_int_vector_t *highest = NULL;
	table->pending.read = table->pending.write = 0;
	for (int i = 0; i < table->vector_count; i++) {
		avr_int_vector_t *vector = table->vector[i];
		vector->pending = is_pending(interrupts, vector);
		if (!vector->pending)
			continue;
		table->pending.buffer[table->pending.write++] = vector;
		if (!highest || vector->vector < highest->vector)
			highest = vector;
	}
	return highest;
}

static void enter_handler(struct interrupts *interrupts, avr_int_vector_t *vector)
{
	avr_t *avr = interrupts->avr;
	avr_int_table_t *table = &avr->interrupts;
	avr_raise_irq(vector->irq + AVR_INT_IRQ_RUNNING, 1);
	avr->cycle += ENTRY_CYCLES + (interrupts->ends_sleep ? WAKE_CYCLES : 0);
	interrupts->ends_sleep = false;
	_avr_push_addr(avr, avr->pc);
	avr_sreg_set(avr, S_I, 0);
	avr->pc = vector->vector * avr->vector_size;
	if (table->running_ptr < ARRAY_SIZE(table->running))
		table->running[table->running_ptr++] = vector;
	avr_clear_interrupt(avr, vector);
	collect_pending(interrupts);
}

bool interrupts_serve(struct interrupts *interrupts)
{
	avr_t *avr = interrupts->avr;
	if (!avr->sreg[S_I]) {
		if (interrupts->needs_check)
			collect_pending(interrupts);
		interrupts->needs_check = false;
		return false;
	}
	if (avr->interrupt_state < 0) {
		/* simavr waits for two instructions after `sei`, the chip for one instruction. */
		if (++avr->interrupt_state < 0)
			return false;
	}
	interrupts->needs_check = false;
	avr_int_vector_t *vector = collect_pending(interrupts);
	avr->interrupt_state = vector != NULL;
	if (!vector)
		return false;
	enter_handler(interrupts, vector);
	return true;
}

static void write_enable(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct interrupts *interrupts = param;
	avr->data[address] = value;
	interrupts_request_check(interrupts);
}

static void write_flags(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct interrupts *interrupts = param;
	avr->data[address] &= ~instruction_written_ones(interrupts->instruction, value);
	interrupts_request_check(interrupts);
}

void interrupts_request_check(struct interrupts *interrupts)
{
	interrupts->needs_check = true;
	interrupts->avr->run_cycle_count = 1; /* simavr returns right after the current instruction */
}

void interrupts_attach(struct interrupts *interrupts, const struct instruction *instruction)
{
	avr_t *avr = instruction->avr;
	const uint16_t enables[] = { REG_TIMSK0, REG_TIMSK1, REG_TIMSK2, REG_PCICR, REG_EIMSK };
	const uint16_t flags[] = { REG_TIFR0, REG_TIFR1, REG_TIFR2 };
	*interrupts = (struct interrupts){ .instruction = instruction, .avr = avr };
	for (size_t i = 0; i < ARRAY_SIZE(enables); i++)
		hook_write(avr, enables[i], write_enable, interrupts);
	for (size_t i = 0; i < ARRAY_SIZE(flags); i++)
		hook_write(avr, flags[i], write_flags, interrupts);
}
