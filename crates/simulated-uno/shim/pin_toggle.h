/* Corrects `sbi PINx, n`: it toggles only pin n. simavr 1.6 toggles every high pin of the port.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "instruction.h"

struct pin_toggle {
	const struct instruction *instruction;
	struct write_hook stock_writes[3]; /* simavr's callbacks for PINB, PINC and PIND */
};

void pin_toggle_attach(struct pin_toggle *toggle, const struct instruction *instruction);
