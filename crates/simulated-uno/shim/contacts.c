/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contacts.h"

/* Offsets of a port's DDR and PORT registers from its PIN register (data sheet, 14.4). */
enum { DDR = 1, PORT = 2 };

static uint8_t read_pin(avr_t *avr, avr_io_addr_t address, void *param)
{
	const struct contacts *contacts = param;
	unsigned port = CHIP_PORT_INDEX(address);
	const struct read_hook *stock_hook = &contacts->stock_hooks[port];
	uint8_t value = stock_hook->callback(avr, address, stock_hook->param);
	uint8_t input_bits = contacts->contact_bits[port] & ~avr->data[address + DDR];
	uint8_t high_bits = avr->data[address + PORT] & ~contacts->closed_bits[port];
	return (value & ~input_bits) | (high_bits & input_bits);
}

void contacts_attach(struct contacts *contacts, avr_t *avr)
{
	for (int i = 0; i < CHIP_PORT_COUNT; i++)
		contacts->stock_hooks[i] = hook_read(avr, CHIP_PIN_REGISTER(i), read_pin, contacts);
}

void contacts_set(struct contacts *contacts, uint8_t number, bool is_closed)
{
	struct chip_pin pin = chip_find_pin(number);
	unsigned port = pin.port - 'B';
	contacts->contact_bits[port] |= 1 << pin.bit;
	contacts->closed_bits[port] &= ~(1 << pin.bit);
	contacts->closed_bits[port] |= is_closed << pin.bit;
}
