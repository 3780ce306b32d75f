/* Times every call of one function of the firmware.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "handlers.h"
#include "list.h"

struct call { uint64_t enter, leave, interrupted; };

struct call_timer {
	const avr_t *avr;
	const struct handlers *handlers;
	bool on;                /* then simavr must run one instruction at a time */
	bool inside;            /* between entry and return */
	uint32_t entry, back;   /* byte addresses in flash */
	uint16_t stack_pointer; /* at entry */
	uint64_t enter, handlers_before;
	struct list calls;      /* struct call */
};

void call_timer_attach(struct call_timer *timer, const avr_t *avr,
                       const struct handlers *handlers);
void call_timer_reset(struct call_timer *timer);
void call_timer_set(struct call_timer *timer, bool on, uint32_t entry);
/* Checks the next instruction for an entry or a return. */
void call_timer_check(struct call_timer *timer);
void call_timer_free(struct call_timer *timer);
