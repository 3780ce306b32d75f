/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "call_timer.h"

void call_timer_attach(struct call_timer *timer, const struct handlers *handlers)
{
	*timer = (struct call_timer){
		.handlers = handlers,
		.calls.item_size = sizeof(struct call),
	};
}

void call_timer_check(struct call_timer *timer)
{
	const avr_t *avr = timer->handlers->avr;
	uint16_t sp = avr->data[R_SPL] | avr->data[R_SPH] << 8;
	/* A return pops the two bytes of the address. */
	if (timer->is_in_call && avr->pc == timer->return_address && sp == timer->stack_pointer + 2) {
		uint64_t interrupt_cycles =
			handlers_cycles(timer->handlers) - timer->handler_cycles_at_entry;
		list_push(&timer->calls,
		          &(struct call){ timer->enter_cycle, avr->cycle, interrupt_cycles });
		timer->is_in_call = false;
	} else if (!timer->is_in_call && avr->pc == timer->entry_address) {
		/* The stack has a word address, high byte first. The firmware may have set any stack
		   pointer, so the address may wrap. */
		uint8_t high = avr->data[(uint16_t)(sp + 1)], low = avr->data[(uint16_t)(sp + 2)];
		timer->return_address = (high << 8 | low) << 1;
		timer->stack_pointer = sp;
		timer->enter_cycle = avr->cycle;
		timer->handler_cycles_at_entry = handlers_cycles(timer->handlers);
		timer->is_in_call = true;
	}
}
