/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pin_toggle.h"

static const uint16_t pin_registers[3] = { REG_PINB, REG_PINC, REG_PIND };

static void write_pin(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct pin_toggle *toggle = param;
	uint8_t bits = instruction_written_bits(toggle->instruction, value);
	for (int i = 0; i < 3; i++)
		if (pin_registers[i] == address)
			toggle->stock_hooks[i].callback(avr, address, bits, toggle->stock_hooks[i].param);
}

void pin_toggle_attach(struct pin_toggle *toggle, const struct instruction *instruction)
{
	toggle->instruction = instruction;
	for (int i = 0; i < 3; i++)
		toggle->stock_hooks[i] = hook_write(instruction->avr, pin_registers[i], write_pin, toggle);
}
