/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chip.h"

#include <stdlib.h>
#include <string.h>

avr_io_t *chip_find_peripheral(avr_t *avr, const char *kind)
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

struct write_hook hook_write(avr_t *avr, uint16_t address, avr_io_write_t callback, void *param)
{
	avr_io_addr_t io = AVR_DATA_TO_IO(address);
	struct write_hook previous = { avr->io[io].w.c, avr->io[io].w.param };
	avr->io[io].w.c = callback;
	avr->io[io].w.param = param;
	return previous;
}

struct read_hook hook_read(avr_t *avr, uint16_t address, avr_io_read_t callback, void *param)
{
	avr_io_addr_t io = AVR_DATA_TO_IO(address);
	struct read_hook previous = { avr->io[io].r.c, avr->io[io].r.param };
	avr->io[io].r.c = callback;
	avr->io[io].r.param = param;
	return previous;
}
