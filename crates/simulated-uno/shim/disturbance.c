/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "disturbance.h"

#include <simavr/sim_core.h>

void disturbance_attach(struct disturbance *disturbance, avr_t *avr,
                        const struct handlers *handlers)
{
	*disturbance = (struct disturbance){ .avr = avr, .handlers = handlers };
}

/* Interrupts are on, and not only since the instruction before. simavr does not
 * count on while the CPU sleeps. */
static bool is_open(const avr_t *avr)
{
	return avr->sreg[S_I] && (avr->interrupt_state >= 0 || avr->state == cpu_Sleeping);
}

/* The instruction after `sei` or a store to SREG is executed before any interrupt. */
static bool follows_enable(const avr_t *avr)
{
	if (avr->pc < 2 || avr->interrupt_state >= 0)
		return false;
	const uint8_t *flash = avr->flash + avr->pc - 2;
	uint16_t before = flash[0] | flash[1] << 8;
	return before == 0x9478 || (before & 0xfe0f) == 0xbe0f;
}

void disturbance_serve(struct disturbance *disturbance)
{
	avr_t *avr = disturbance->avr;
	if (!disturbance->held || !is_open(avr))
		return;
	avr->state = cpu_Running;
	/* Cycle by cycle: whatever is due meanwhile, such as a byte after a byte, is
	 * due at its own time. */
	for (; disturbance->held; disturbance->held--) {
		avr->cycle++;
		avr_cycle_timer_process(avr);
	}
}

bool disturbance_waits(const struct disturbance *disturbance)
{
	return disturbance->held || disturbance->avr->cycle < disturbance->stalled_until;
}

bool disturbance_stalls(const struct disturbance *disturbance)
{
	const avr_t *avr = disturbance->avr;
	return avr->cycle < disturbance->stalled_until && !disturbance->handlers->depth &&
	       avr->sreg[S_I] && !follows_enable(avr);
}

void disturbance_wait(struct disturbance *disturbance, uint64_t until)
{
	avr_t *avr = disturbance->avr;
	uint64_t end = until < disturbance->stalled_until ? until : disturbance->stalled_until;
	uint64_t event = avr_cycle_timer_process(avr);
	uint64_t left = end > avr->cycle ? end - avr->cycle : 0;
	if (avr->interrupt_state)
		event = 1; /* an interrupt is about to be served */
	avr->cycle += event < left ? event : left;
	avr_cycle_timer_process(avr);
}
