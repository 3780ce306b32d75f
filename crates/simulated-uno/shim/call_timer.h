/* Times every call of one function of the firmware.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "handlers.h"
#include "list.h"

struct call {
	uint64_t enter_cycle;      /* cycle of the first instruction */
	uint64_t leave_cycle;      /* cycle after the return */
	uint64_t interrupt_cycles; /* cycles of the interrupts during the call */
};

struct call_timer {
	const struct handlers *handlers;
	bool is_enabled;         /* true while calls are timed, one instruction at a time */
	bool is_in_call;         /* true between the entry and the return of a timed call */
	uint32_t entry_address;  /* byte address of the function in flash */
	/* The timed call in progress: */
	uint32_t return_address; /* byte address in flash after the call instruction */
	uint16_t stack_pointer;  /* stack pointer at the entry */
	uint64_t enter_cycle;    /* cycle of the entry */
	uint64_t handler_cycles_at_entry; /* handlers_cycles at the entry */
	struct list calls;       /* completed calls: struct call */
};

void call_timer_attach(struct call_timer *timer, const struct handlers *handlers);
/* Detects the start and the end of a timed call; must be called before each instruction. */
void call_timer_check(struct call_timer *timer);
