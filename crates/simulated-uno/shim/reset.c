/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reset.h"

#include <stdlib.h>
#include <string.h>

#define REGISTER_COUNT 32 /* r0 to r31 */
#define INITIAL_NOISE_STATE UINT64_C(0x2545f4914f6cdd1d)

/* "The bit is reset by a Power-on Reset, or by writing a logic zero to the
 * flag" (11.9.1): writing a one has no effect. */
static void write_mcusr(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct reset *reset = param;
	reset->mcusr &= value;
	avr->data[address] = reset->mcusr;
}

void reset_attach(struct reset *reset, avr_t *avr, bool follows_data_sheet)
{
	*reset = (struct reset){
		.avr = avr,
		.follows_data_sheet = follows_data_sheet,
		.noise_state = INITIAL_NOISE_STATE,
		.initial_sram = calloc(1, avr->ramend + 1),
		.events.item_size = sizeof(struct reset_event),
	};
	if (!reset->initial_sram)
		abort();
	if (follows_data_sheet)
		hook_write(avr, REG_MCUSR, write_mcusr, reset);
}

void reset_request(struct reset *reset, enum reset_cause cause)
{
	reset->requested_causes |= cause;
	reset->avr->run_cycle_count = 1;
}

void reset_request_power_cut(struct reset *reset)
{
	reset->is_power_cut_requested = true;
	reset->avr->run_cycle_count = 1;
}

void reset_stop_timers(const struct reset *reset)
{
	static const uint16_t control_registers[] = {
		REG_TCCR0B, REG_TCCR1B, REG_TCCR2B, REG_TCCR0A, REG_TCCR1A, REG_TCCR2A,
	};
	avr_t *avr = reset->avr;
	for (size_t i = 0; i < ARRAY_SIZE(control_registers); i++) {
		avr_io_addr_t io = AVR_DATA_TO_IO(control_registers[i]);
		if (avr->io[io].w.c)
			avr->io[io].w.c(avr, control_registers[i], 0, avr->io[io].w.param);
	}
}

/* Returns the cause that is recorded if several causes occur at once. */
static uint8_t main_cause(uint8_t causes)
{
	static const uint8_t causes_by_rank[] = { RESET_POWER_ON, RESET_BROWN_OUT, RESET_WATCHDOG };
	for (size_t i = 0; i < ARRAY_SIZE(causes_by_rank); i++)
		if (causes & causes_by_rank[i])
			return causes_by_rank[i];
	return RESET_EXTERNAL;
}

void reset_record(struct reset *reset, uint8_t causes, uint64_t now)
{
	causes &= ~RESET_HOLD;
	if (causes) {
		struct reset_event *event = list_push(&reset->events);
		*event = (struct reset_event){ now, main_cause(causes) };
	}
	if (causes & RESET_POWER_ON)
		reset->mcusr = RESET_POWER_ON;
	else if (causes && !reset->follows_data_sheet)
		reset->mcusr = causes; /* stock simavr discards the earlier causes */
	else
		reset->mcusr |= causes;
	if (reset->has_boot_loader)
		reset->mcusr = 0;
}

void reset_restore_mcusr(const struct reset *reset)
{
	reset->avr->data[REG_MCUSR] = reset->mcusr;
}

/* Returns the next byte of a xorshift64* generator. */
static uint8_t next_noise(struct reset *reset)
{
	reset->noise_state ^= reset->noise_state >> 12;
	reset->noise_state ^= reset->noise_state << 25;
	reset->noise_state ^= reset->noise_state >> 27;
	return reset->noise_state * UINT64_C(0x2545f4914f6cdd1d) >> 56;
}

void reset_fill_sram(struct reset *reset)
{
	avr_t *avr = reset->avr;
	for (uint32_t address = 0; address <= avr->ramend; address++)
		if (address < REGISTER_COUNT || address >= CHIP_SRAM_START)
			avr->data[address] = next_noise(reset);
	memcpy(reset->initial_sram, avr->data, avr->ramend + 1);
}

uint16_t reset_first_changed(const struct reset *reset, uint16_t from)
{
	uint16_t address = from;
	const avr_t *avr = reset->avr;
	while (address <= avr->ramend && avr->data[address] == reset->initial_sram[address])
		address++;
	return address;
}
