/* The current instruction: the cycle at which its store takes effect, and the bits that it writes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

/* Runs the chip's instructions, and describes the current one. */
struct instruction {
	avr_t *avr;
	bool is_executing; /* true during an instruction, false during a callback of a simavr timer */
};

/* Executes the next instruction, or several, up to avr->run_cycle_limit cycles. */
void instruction_run(struct instruction *instruction);
/* The cycle at which the current store takes effect: the end of its instruction. Outside an
 * instruction, the current cycle. simavr calls a register's callback at the start of the instruction,
 * so an edge made by `sbi` would be one cycle early compared with an edge made by `out`. */
uint64_t instruction_store_cycle(const struct instruction *instruction);
/* The bits to which the instruction writes a one, given the `value` that simavr reports: `sbi`
 * writes a single bit, but simavr implements it as a read and a write of all eight bits. */
uint8_t instruction_written_ones(const struct instruction *instruction, uint8_t value);
/* The bits of an I/O register that the current instruction can change: one bit for `sbi` and `cbi`,
 * otherwise all bits. */
uint8_t instruction_touched_bits(const struct instruction *instruction);
