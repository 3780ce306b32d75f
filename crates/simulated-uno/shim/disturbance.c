/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "disturbance.h"

#include <simavr/sim_core.h>

/* True if interrupts have been enabled for at least one instruction. Until then, interrupt_state
 * is negative; simavr does not increment it while the CPU sleeps. */
static bool accepts_interrupts(const avr_t *avr)
{
	return avr->sreg[S_I] && (avr->interrupt_state >= 0 || avr->state == cpu_Sleeping);
}

/* True if the previous instruction, `sei` or an `out` to SREG, has enabled interrupts: the next
 * instruction is then executed before any interrupt. */
static bool follows_enable(const avr_t *avr)
{
	if (avr->pc < 2 || avr->interrupt_state >= 0)
		return false;
	const uint8_t *flash = avr->flash + avr->pc - 2;
	uint16_t previous_opcode = flash[0] | flash[1] << 8;
	return previous_opcode == 0x9478 || (previous_opcode & 0xfe0f) == 0xbe0f;
}

void disturbance_serve(struct disturbance *disturbance)
{
	avr_t *avr = disturbance->avr;
	if (!disturbance->foreign_cycles_left || !accepts_interrupts(avr))
		return;
	avr->state = cpu_Running;
	/* Cycle by cycle, so that each event meanwhile, such as the arrival of a byte, happens at
	 * its own time. */
	for (; disturbance->foreign_cycles_left; disturbance->foreign_cycles_left--) {
		avr->cycle++;
		avr_cycle_timer_process(avr);
	}
}

bool disturbance_is_active(const struct disturbance *disturbance)
{
	return disturbance->foreign_cycles_left || disturbance->avr->cycle < disturbance->stalled_until;
}

bool disturbance_stalls_main(const struct disturbance *disturbance)
{
	const avr_t *avr = disturbance->avr;
	return avr->cycle < disturbance->stalled_until && !disturbance->handlers->depth &&
	       avr->sreg[S_I] && !follows_enable(avr);
}

void disturbance_advance_stall(struct disturbance *disturbance, uint64_t until)
{
	avr_t *avr = disturbance->avr;
	uint64_t end = until < disturbance->stalled_until ? until : disturbance->stalled_until;
	uint64_t cycles_to_event = avr_cycle_timer_process(avr);
	uint64_t cycles_to_end = end > avr->cycle ? end - avr->cycle : 0;
	if (avr->interrupt_state)
		cycles_to_event = 1; /* an interrupt is about to be served */
	avr->cycle += cycles_to_event < cycles_to_end ? cycles_to_event : cycles_to_end;
	avr_cycle_timer_process(avr);
}
