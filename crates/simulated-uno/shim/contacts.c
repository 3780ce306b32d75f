/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contacts.h"

/* Offsets of a port's DDR and PORT registers from its PIN register (data sheet, 14.4). */
enum { DDR = 1, PORT = 2 };

static const uint16_t pin_registers[CONTACT_PORT_COUNT] = { REG_PINB, REG_PINC, REG_PIND };

static uint8_t read_pin(avr_t *avr, avr_io_addr_t address, void *param)
{
	struct contacts *contacts = param;
	uint8_t value = avr->data[address];
	for (int i = 0; i < CONTACT_PORT_COUNT; i++) {
		if (pin_registers[i] != address)
			continue;
		const struct read_hook *stock_hook = &contacts->stock_hooks[i];
		if (stock_hook->callback)
			value = stock_hook->callback(avr, address, stock_hook->param);
		uint8_t input_bits = contacts->contact_bits[i] & ~avr->data[address + DDR];
		uint8_t high_bits = avr->data[address + PORT] & ~contacts->closed_bits[i];
		value = (value & ~input_bits) | (high_bits & input_bits);
	}
	return value;
}

void contacts_attach(struct contacts *contacts, avr_t *avr)
{
	for (int i = 0; i < CONTACT_PORT_COUNT; i++)
		contacts->stock_hooks[i] = hook_read(avr, pin_registers[i], read_pin, contacts);
}

void contacts_set(struct contacts *contacts, uint16_t address, uint8_t bit, bool is_closed)
{
	for (int i = 0; i < CONTACT_PORT_COUNT; i++) {
		if (pin_registers[i] != address)
			continue;
		contacts->contact_bits[i] |= 1 << bit;
		contacts->closed_bits[i] &= ~(1 << bit);
		contacts->closed_bits[i] |= is_closed << bit;
	}
}
