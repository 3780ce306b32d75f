/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "instruction.h"

#include <simavr/sim_core.h>

static uint16_t opcode(const avr_t *avr)
{
	const uint8_t *flash = avr->flash + avr->pc;
	return flash[0] | flash[1] << 8;
}

void instruction_run(struct instruction *instruction)
{
	avr_t *avr = instruction->avr;
	instruction->is_executing = true;
	avr->pc = avr_run_one(avr);
	instruction->is_executing = false;
}

uint64_t instruction_store_cycle(const struct instruction *instruction)
{
	const avr_t *avr = instruction->avr;
	if (!instruction->is_executing)
		return avr->cycle;
	bool is_out = (opcode(avr) & 0xf800) == 0xb800;
	return avr->cycle + (is_out ? 1 : 2); /* sbi, cbi, st, sts: 2 cycles */
}

uint8_t instruction_written_ones(const struct instruction *instruction, uint8_t value)
{
	uint16_t code = opcode(instruction->avr);
	bool is_sbi = instruction->is_executing && (code & 0xff00) == 0x9a00;
	return is_sbi ? 1 << (code & 7) : value;
}

uint8_t instruction_touched_bits(const struct instruction *instruction)
{
	uint16_t code = opcode(instruction->avr);
	bool is_bit_instruction = instruction->is_executing && (code & 0xfd00) == 0x9800; /* cbi, sbi */
	return is_bit_instruction ? 1 << (code & 7) : 0xff;
}
