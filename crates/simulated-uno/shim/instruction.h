/* The instruction being executed: the cycle at which its store takes effect, and
 * the bits that it writes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "chip.h"

struct instruction {
	avr_t *avr;
	bool executing; /* inside an instruction, not inside a timer */
};

/* Executes the next instruction, or several until avr->run_cycle_limit. */
void instruction_run(struct instruction *instruction);
/* The cycle at which the store being executed takes effect: the last one of its
 * instruction. simavr calls back at the first, by which an edge of `sbi` would be
 * a cycle early compared with one of `out`. */
uint64_t instruction_effect_cycle(const struct instruction *instruction);
/* The ones that the instruction writes, given the `value` that simavr reports: `sbi` writes one
 * bit only, but simavr makes it a read and a write of all eight. */
uint8_t instruction_written_bits(const struct instruction *instruction, uint8_t value);
/* The bits of an I/O register that the instruction being executed can change:
 * one if it is `sbi` or `cbi`, else all. */
uint8_t instruction_touched_bits(const struct instruction *instruction);
/* The CPU stands still for `cycles` after the instruction being executed. simavr
 * does not count them in its slice: end that, too, or timers are late. */
void instruction_halt_cpu(const struct instruction *instruction, unsigned cycles);
/* Ends simavr's slice of many instructions, so that interrupts and timers are served right after
 * the instruction being executed. */
void instruction_end_slice(const struct instruction *instruction);
