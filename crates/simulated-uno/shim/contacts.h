/* Contacts between pins and ground, such as push buttons. An input pin with a contact is low
 * while the contact is closed. While the contact is open, the pull-up makes the pin high (data
 * sheet, 14.2.1); without a pull-up the pin floats and is read as low.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

struct contacts {
	/* All arrays are indexed by port: B, C, D. */
	struct read_hook stock_hooks[CHIP_PORT_COUNT]; /* simavr's callbacks for the PIN registers */
	uint8_t contact_bits[CHIP_PORT_COUNT]; /* pins that have a contact */
	uint8_t closed_bits[CHIP_PORT_COUNT];  /* pins whose contact is closed */
};

void contacts_attach(struct contacts *contacts, avr_t *avr);
/* Closes or opens the contact at the pin with this Arduino number. The first call for a pin adds the
 * contact. */
void contacts_set(struct contacts *contacts, uint8_t number, bool is_closed);
