/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chip.h"

#include <stdlib.h>
#include <string.h>

struct chip_pin chip_find_pin(uint8_t number)
{
	if (number < 8)
		return (struct chip_pin){ 'D', number };
	if (number < 14)
		return (struct chip_pin){ 'B', number - 8 };
	return (struct chip_pin){ 'C', number - 14 };
}

avr_io_t *chip_find_peripheral(avr_t *avr, const char *kind)
{
	for (avr_io_t *io = avr->io_port; io; io = io->next)
		if (strcmp(io->kind, kind) == 0)
			return io;
	abort();
}

void chip_call_at(avr_t *avr, uint64_t cycle, avr_cycle_timer_t timer, void *param)
{
	avr_cycle_timer_register(avr, cycle > avr->cycle ? cycle - avr->cycle : 1, timer, param);
}

void chip_store(avr_t *avr, uint16_t address, uint8_t value)
{
	avr_io_addr_t io = AVR_DATA_TO_IO(address);
	if (address >= CHIP_IO_START && io < MAX_IOs && avr->io[io].w.c)
		avr->io[io].w.c(avr, address, value, avr->io[io].w.param);
	else if (address <= avr->ramend)
		avr->data[address] = value;
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

void hook_read_and_write(avr_t *avr, uint16_t address, avr_io_read_t read, avr_io_write_t write,
                         void *param)
{
	hook_read(avr, address, read, param);
	hook_write(avr, address, write, param);
}
