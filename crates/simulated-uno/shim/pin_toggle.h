/* Makes `sbi PINx, n` toggle only pin n, as on the chip; simavr 1.6 also toggles all other high
 * pins of the port.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "instruction.h"

struct pin_toggle {
	const struct instruction *instruction;
	struct write_hook stock_hooks[CHIP_PORT_COUNT]; /* simavr's callbacks for PINB, PINC and PIND */
};

void pin_toggle_attach(struct pin_toggle *toggle, const struct instruction *instruction);
