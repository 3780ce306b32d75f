/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "call_timer.h"

void call_timer_attach(struct call_timer *timer, const avr_t *avr,
                       const struct handlers *handlers)
{
	*timer = (struct call_timer){
		.avr = avr,
		.handlers = handlers,
		.calls.size = sizeof(struct call),
	};
}

void call_timer_reset(struct call_timer *timer)
{
	timer->inside = false;
}

void call_timer_set(struct call_timer *timer, bool on, uint32_t entry)
{
	timer->on = on;
	timer->entry = entry;
	timer->inside = false;
}

void call_timer_check(struct call_timer *timer)
{
	const avr_t *avr = timer->avr;
	uint16_t sp = avr->data[R_SPL] | avr->data[R_SPH] << 8;
	if (timer->inside && avr->pc == timer->back && sp == timer->stack_pointer + 2) {
		uint64_t interrupted = handlers_cycles(timer->handlers) - timer->handlers_before;
		struct call *call = list_push(&timer->calls);
		*call = (struct call){ timer->enter, avr->cycle, interrupted };
		timer->inside = false;
	} else if (!timer->inside && avr->pc == timer->entry) {
		/* The stack pointer may be anything, and wraps. */
		uint8_t high = avr->data[(uint16_t)(sp + 1)], low = avr->data[(uint16_t)(sp + 2)];
		timer->back = (high << 8 | low) << 1;
		timer->stack_pointer = sp;
		timer->enter = avr->cycle;
		timer->handlers_before = handlers_cycles(timer->handlers);
		timer->inside = true;
	}
}

void call_timer_free(struct call_timer *timer)
{
	list_free(&timer->calls);
}
