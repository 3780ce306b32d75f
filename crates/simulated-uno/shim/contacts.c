/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contacts.h"

/* Behind a port's PIN register, DDR and then PORT (data sheet, 14.4). */
enum { DDR = 1, PORT = 2 };

static const uint16_t registers[CONTACT_PORTS] = { REG_PINB, REG_PINC, REG_PIND };

static uint8_t read_pin(avr_t *avr, avr_io_addr_t address, void *param)
{
	struct contacts *contacts = param;
	uint8_t value = avr->data[address];
	for (int i = 0; i < CONTACT_PORTS; i++) {
		if (registers[i] != address)
			continue;
		if (contacts->read[i].call)
			value = contacts->read[i].call(avr, address, contacts->read[i].param);
		uint8_t inputs = contacts->attached[i] & ~avr->data[address + DDR];
		uint8_t high = avr->data[address + PORT] & ~contacts->closed[i];
		value = (value & ~inputs) | (high & inputs);
	}
	return value;
}

void contacts_attach(struct contacts *contacts, avr_t *avr)
{
	for (int i = 0; i < CONTACT_PORTS; i++)
		contacts->read[i] = hook_read(avr, registers[i], read_pin, contacts);
}

void contacts_set(struct contacts *contacts, uint16_t address, uint8_t bit, bool closed)
{
	for (int i = 0; i < CONTACT_PORTS; i++) {
		if (registers[i] != address)
			continue;
		contacts->attached[i] |= 1 << bit;
		contacts->closed[i] &= ~(1 << bit);
		contacts->closed[i] |= closed << bit;
	}
}
