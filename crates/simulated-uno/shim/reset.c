/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reset.h"

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
		.events.item_size = sizeof(struct reset_event),
	};
	if (follows_data_sheet)
		hook_write(avr, REG_MCUSR, write_mcusr, reset);
}

void reset_request(struct reset *reset, enum reset_cause cause)
{
	reset->requested_causes |= cause;
	reset->avr->run_cycle_count = 1; /* simavr returns right after the current instruction */
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
	if (causes)
		list_push(&reset->events, &(struct reset_event){ now, main_cause(causes) });
	if (causes & RESET_POWER_ON)
		reset->mcusr = RESET_POWER_ON;
	else if (causes && !reset->follows_data_sheet)
		reset->mcusr = causes; /* stock simavr discards the earlier causes */
	else
		reset->mcusr |= causes;
	if (reset->has_boot_loader)
		reset->mcusr = 0;
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
	for (uint32_t address = 0; address < CHIP_SRAM_END; address++)
		if (address < REGISTER_COUNT || address >= CHIP_SRAM_START)
			avr->data[address] = next_noise(reset);
	memcpy(reset->initial_sram, avr->data, CHIP_SRAM_END);
}
