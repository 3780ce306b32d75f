/* What simavr 1.6 gets wrong about interrupts, Timer1 and port pins, put right
 * by the ATmega328P's data sheet.
 *
 * - An interrupt takes 4 cycles to enter, 4 more from sleep (7.7.1).
 * - Interrupts are levels: an enabled one with its flag up fires, whenever it
 *   was enabled, and one instruction after `sei`.
 * - The high byte of a 16-bit register of Timer1 goes through TEMP, one byte
 *   that they all share (16.3).
 * - A one written to TIFRn clears that flag and no other.
 * - `sbi PINx, n` toggles pin n alone.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "uno.h"

#include <simavr/sim_core.h>

#define ENTRY_CYCLES 4
#define WAKE_CYCLES 4

static const uint16_t timer1_low[4] = { REG_TCNT1L, REG_ICR1L, REG_OCR1AL, REG_OCR1BL };
static const uint16_t pin_registers[3] = { REG_PINB, REG_PINC, REG_PIND };

static bool is_due(avr_t *avr, const avr_int_vector_t *vector)
{
	if (!avr_regbit_get(avr, vector->enable))
		return false;
	return vector->raised.reg ? avr_regbit_get(avr, vector->raised) : vector->pending;
}

/* Rebuilds simavr's list of pending interrupts, which `sleep` looks at, from
 * the flags. Returns the one that outranks the others. */
static avr_int_vector_t *collect_due(avr_t *avr)
{
	avr_int_table_t *table = &avr->interrupts;
	avr_int_vector_t *first = NULL;
	table->pending.read = table->pending.write = 0;
	for (int i = 0; i < table->vector_count; i++) {
		avr_int_vector_t *vector = table->vector[i];
		vector->pending = is_due(avr, vector);
		if (!vector->pending)
			continue;
		table->pending.buffer[table->pending.write++] = vector;
		if (!first || vector->vector < first->vector)
			first = vector;
	}
	return first;
}

static void enter(struct uno *uno, avr_int_vector_t *vector)
{
	avr_t *avr = uno->avr;
	avr_int_table_t *table = &avr->interrupts;
	avr_raise_irq(vector->irq + AVR_INT_IRQ_RUNNING, 1);
	avr->cycle += ENTRY_CYCLES + (uno->slept ? WAKE_CYCLES : 0);
	uno->slept = false;
	_avr_push_addr(avr, avr->pc);
	avr_sreg_set(avr, S_I, 0);
	avr->pc = vector->vector * avr->vector_size;
	if (table->running_ptr < ARRAY_SIZE(table->running))
		table->running[table->running_ptr++] = vector;
	avr_clear_interrupt(avr, vector);
	collect_due(avr);
}

bool datasheet_service_interrupts(struct uno *uno)
{
	avr_t *avr = uno->avr;
	if (!avr->sreg[S_I]) {
		if (uno->recheck)
			collect_due(avr);
		uno->recheck = false;
		return false;
	}
	if (avr->interrupt_state < 0) {
		/* simavr counts two instructions after `sei`; silicon one. */
		if (++avr->interrupt_state < 0)
			return false;
	}
	uno->recheck = false;
	avr_int_vector_t *vector = collect_due(avr);
	avr->interrupt_state = vector != NULL;
	if (!vector)
		return false;
	enter(uno, vector);
	return true;
}

static void write_enable(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct uno *uno = param;
	avr->data[addr] = value;
	uno->recheck = true;
}

static void write_flags(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct uno *uno = param;
	avr->data[addr] &= ~uno_written_bits(uno, value);
	uno->recheck = true;
}

static void write_high(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	(void)avr;
	(void)addr;
	((struct uno *)param)->temp = value;
}

static void write_low(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct uno *uno = param;
	avr->data[addr + 1] = uno->temp;
	for (int i = 0; i < 4; i++) {
		if (timer1_low[i] != addr)
			continue;
		if (uno->timer1_low[i])
			uno->timer1_low[i](avr, addr, value, uno->timer1_low_param[i]);
		else
			avr->data[addr] = value;
	}
}

static uint8_t read_count_low(avr_t *avr, avr_io_addr_t addr, void *param)
{
	struct uno *uno = param;
	uint8_t low = uno->tcnt_read(avr, addr, uno->tcnt_read_param);
	uno->temp = avr->data[addr + 1];
	return low;
}

static uint8_t read_temp(avr_t *avr, avr_io_addr_t addr, void *param)
{
	(void)avr;
	(void)addr;
	return ((struct uno *)param)->temp;
}

static uint8_t read_capture_low(avr_t *avr, avr_io_addr_t addr, void *param)
{
	((struct uno *)param)->temp = avr->data[addr + 1];
	return avr->data[addr];
}

static void write_pin(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct uno *uno = param;
	for (int i = 0; i < 3; i++)
		if (pin_registers[i] == addr)
			uno->pin_write[i](avr, addr, uno_written_bits(uno, value),
			                  uno->pin_write_param[i]);
}

static void take_write(struct uno *uno, uint16_t addr, avr_io_write_t write,
                       avr_io_write_t *old, void **old_param)
{
	avr_io_addr_t io = AVR_DATA_TO_IO(addr);
	if (old) {
		*old = uno->avr->io[io].w.c;
		*old_param = uno->avr->io[io].w.param;
	}
	uno->avr->io[io].w.c = write;
	uno->avr->io[io].w.param = uno;
}

static void take_read(struct uno *uno, uint16_t addr, avr_io_read_t read)
{
	avr_io_addr_t io = AVR_DATA_TO_IO(addr);
	uno->avr->io[io].r.c = read;
	uno->avr->io[io].r.param = uno;
}

void datasheet_attach(struct uno *uno)
{
	avr_t *avr = uno->avr;
	const uint16_t enables[] = { REG_TIMSK0, REG_TIMSK1, REG_TIMSK2, REG_PCICR, REG_EIMSK };
	const uint16_t flags[] = { REG_TIFR0, REG_TIFR1, REG_TIFR2 };
	for (size_t i = 0; i < ARRAY_SIZE(enables); i++)
		take_write(uno, enables[i], write_enable, NULL, NULL);
	for (size_t i = 0; i < ARRAY_SIZE(flags); i++)
		take_write(uno, flags[i], write_flags, NULL, NULL);
	for (size_t i = 0; i < ARRAY_SIZE(timer1_low); i++) {
		take_write(uno, timer1_low[i], write_low,
		           &uno->timer1_low[i], &uno->timer1_low_param[i]);
		take_write(uno, timer1_low[i] + 1, write_high, NULL, NULL);
	}
	for (size_t i = 0; i < ARRAY_SIZE(pin_registers); i++)
		take_write(uno, pin_registers[i], write_pin,
		           &uno->pin_write[i], &uno->pin_write_param[i]);
	uno->tcnt_read = avr->io[AVR_DATA_TO_IO(REG_TCNT1L)].r.c;
	uno->tcnt_read_param = avr->io[AVR_DATA_TO_IO(REG_TCNT1L)].r.param;
	take_read(uno, REG_TCNT1L, read_count_low);
	take_read(uno, REG_TCNT1L + 1, read_temp);
	take_read(uno, REG_ICR1L, read_capture_low);
	take_read(uno, REG_ICR1L + 1, read_temp);
}
