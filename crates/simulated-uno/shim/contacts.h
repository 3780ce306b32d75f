/* Contacts between pins and ground, such as push buttons. The level of an input pin with a
 * contact is low while that is closed; while it is open, the pull-up makes it high (data sheet, 14.2.1), and
 * without a pull-up it is taken to be low: a program must not rely on a pin that floats.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

#define CONTACT_PORTS 3

struct contacts {
	struct read_hook read[CONTACT_PORTS]; /* simavr's, of ports B, C and D */
	uint8_t attached[CONTACT_PORTS], closed[CONTACT_PORTS];
};

void contacts_attach(struct contacts *contacts, avr_t *avr);
/* Puts a contact at a pin, bit `bit` of the port whose PIN register this is. */
void contacts_set(struct contacts *contacts, uint16_t address, uint8_t bit, bool closed);
