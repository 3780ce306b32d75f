/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chip.h"

#include <stdlib.h>
#include <string.h>

avr_io_t *chip_part(avr_t *avr, const char *kind)
{
	for (avr_io_t *io = avr->io_port; io; io = io->next)
		if (strcmp(io->kind, kind) == 0)
			return io;
	abort();
}

uint64_t chip_cycles_until(const avr_t *avr, uint64_t cycle)
{
	return cycle > avr->cycle ? cycle - avr->cycle : 1;
}
