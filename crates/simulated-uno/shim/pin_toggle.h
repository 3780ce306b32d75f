/* Correction: `sbi PINx, n` toggles pin n alone. simavr 1.6 toggles every pin of the port that is
 * high.
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
