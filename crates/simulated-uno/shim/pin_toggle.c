/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pin_toggle.h"

static void write_pinx(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	const struct pin_toggle *toggle = param;
	const struct write_hook *stock_hook = &toggle->stock_hooks[CHIP_PORT_INDEX(address)];
	uint8_t bits = instruction_written_ones(toggle->instruction, value);
	stock_hook->callback(avr, address, bits, stock_hook->param);
}

void pin_toggle_attach(struct pin_toggle *toggle, const struct instruction *instruction)
{
	toggle->instruction = instruction;
	for (int i = 0; i < CHIP_PORT_COUNT; i++)
		toggle->stock_hooks[i] =
			hook_write(instruction->avr, CHIP_PIN_REGISTER(i), write_pinx, toggle);
}
