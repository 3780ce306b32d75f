/* What src/boot.rs sees of the boot loader and of flash.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "board.h"

void uno_boot_at(struct uno *uno, uint32_t address)
{
	uno->avr->codeend = uno->avr->flashend; /* more code may come */
	uno->avr->reset_pc = address;
	uno->avr->pc = address;
}

uint8_t *uno_flash(struct uno *uno) { return uno->avr->flash; }
