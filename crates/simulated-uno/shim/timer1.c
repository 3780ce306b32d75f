/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "timer1.h"

static void write_high(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	((struct timer1 *)param)->temp = value;
}

static void write_low(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct timer1 *timer1 = param;
	const struct write_hook *stock_hook = &timer1->stock_low_hooks[(address - REG_TCNT1L) / 2];
	avr->data[address + 1] = timer1->temp;
	if (stock_hook->callback)
		stock_hook->callback(avr, address, value, stock_hook->param);
	else
		avr->data[address] = value;
}

static uint8_t read_count_low(avr_t *avr, avr_io_addr_t address, void *param)
{
	struct timer1 *timer1 = param;
	const struct read_hook *stock_hook = &timer1->stock_count_hook;
	uint8_t low = stock_hook->callback(avr, address, stock_hook->param); /* updates both bytes */
	timer1->temp = avr->data[address + 1];
	return low;
}

static uint8_t read_capture_low(avr_t *avr, avr_io_addr_t address, void *param)
{
	((struct timer1 *)param)->temp = avr->data[address + 1];
	return avr->data[address];
}

static uint8_t read_temp(avr_t *avr, avr_io_addr_t address, void *param)
{
	return ((struct timer1 *)param)->temp;
}

void timer1_attach(struct timer1 *timer1, avr_t *avr)
{
	for (int i = 0; i < TIMER1_REGISTER_COUNT; i++) {
		uint16_t low_byte = REG_TCNT1L + 2 * i;
		timer1->stock_low_hooks[i] = hook_write(avr, low_byte, write_low, timer1);
		hook_write(avr, low_byte + 1, write_high, timer1);
	}
	timer1->stock_count_hook = hook_read(avr, REG_TCNT1L, read_count_low, timer1);
	hook_read(avr, REG_TCNT1L + 1, read_temp, timer1);
	hook_read(avr, REG_ICR1L, read_capture_low, timer1);
	hook_read(avr, REG_ICR1L + 1, read_temp, timer1);
}
