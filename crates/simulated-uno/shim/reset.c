/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reset.h"

#include <stdlib.h>
#include <string.h>

#define REGISTERS 32 /* r0 to r31 */
#define FIRST_NOISE UINT64_C(0x2545f4914f6cdd1d)

/* "The bit is reset by a Power-on Reset, or by writing a logic zero to the
 * flag" (11.9.1): a one written changes nothing. */
static void write_flags(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct reset *reset = param;
	reset->flags &= value;
	avr->data[address] = reset->flags;
}

void reset_attach(struct reset *reset, avr_t *avr, bool data_sheet)
{
	*reset = (struct reset){
		.avr = avr,
		.data_sheet = data_sheet,
		.noise = FIRST_NOISE,
		.sram = calloc(1, avr->ramend + 1),
		.events.size = sizeof(struct reset_event),
	};
	if (!reset->sram)
		abort();
	if (data_sheet)
		hook_write(avr, REG_MCUSR, write_flags, reset);
}

void reset_ask(struct reset *reset, enum reset_cause cause)
{
	reset->asked |= cause;
	reset->avr->run_cycle_count = 1;
}

void reset_ask_power_cut(struct reset *reset)
{
	reset->cut_asked = true;
	reset->avr->run_cycle_count = 1;
}

void reset_stop_timers(const struct reset *reset)
{
	static const uint16_t control[] = {
		REG_TCCR0B, REG_TCCR1B, REG_TCCR2B, REG_TCCR0A, REG_TCCR1A, REG_TCCR2A,
	};
	avr_t *avr = reset->avr;
	for (size_t i = 0; i < ARRAY_SIZE(control); i++) {
		avr_io_addr_t io = AVR_DATA_TO_IO(control[i]);
		if (avr->io[io].w.c)
			avr->io[io].w.c(avr, control[i], 0, avr->io[io].w.param);
	}
}

/* The one cause that is recorded of several at once. */
static uint8_t main_cause(uint8_t causes)
{
	static const uint8_t order[] = { RESET_POWER_ON, RESET_BROWN_OUT, RESET_WATCHDOG };
	for (size_t i = 0; i < ARRAY_SIZE(order); i++)
		if (causes & order[i])
			return order[i];
	return RESET_EXTERNAL;
}

void reset_note(struct reset *reset, uint8_t cause, uint64_t now)
{
	cause &= ~RESET_HOLD;
	if (cause) {
		struct reset_event *event = list_push(&reset->events);
		*event = (struct reset_event){ now, main_cause(cause) };
	}
	if (cause & RESET_POWER_ON)
		reset->flags = RESET_POWER_ON;
	else if (cause && !reset->data_sheet)
		reset->flags = cause; /* stock simavr forgets the others */
	else
		reset->flags |= cause;
	if (reset->boot_loader)
		reset->flags = 0;
}

void reset_show(const struct reset *reset)
{
	reset->avr->data[REG_MCUSR] = reset->flags;
}

/* xorshift64* */
static uint8_t next_noise(struct reset *reset)
{
	reset->noise ^= reset->noise >> 12;
	reset->noise ^= reset->noise << 25;
	reset->noise ^= reset->noise >> 27;
	return reset->noise * UINT64_C(0x2545f4914f6cdd1d) >> 56;
}

void reset_fill_sram(struct reset *reset)
{
	avr_t *avr = reset->avr;
	for (uint32_t address = 0; address <= avr->ramend; address++)
		if (address < REGISTERS || address >= CHIP_SRAM)
			avr->data[address] = next_noise(reset);
	memcpy(reset->sram, avr->data, avr->ramend + 1);
}

uint16_t reset_first_used(const struct reset *reset, uint16_t from)
{
	uint16_t address = from;
	const avr_t *avr = reset->avr;
	while (address <= avr->ramend && avr->data[address] == reset->sram[address])
		address++;
	return address;
}

void reset_free(struct reset *reset)
{
	free(reset->sram);
	list_free(&reset->events);
}
