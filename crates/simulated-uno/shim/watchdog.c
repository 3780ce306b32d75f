/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "watchdog.h"

enum { /* WDTCSR */
	WDIF = 1 << 7, WDIE = 1 << 6, WDP3 = 1 << 5, WDCE = 1 << 4, WDE = 1 << 3,
	WDP = WDP3 | 7,
};

#define OSCILLATOR_HZ 128000u
#define SHORTEST_PERIOD 2048u /* with WDP = 0, oscillator cycles */
#define MAX_WDP 9 /* higher values are reserved */
#define CHANGE_WINDOW_CYCLES 4 /* time after WDCE is set in which WDE and WDP may change */

/* The time-out in CPU cycles, given WDTCSR. */
static uint64_t period_cycles(uint8_t control)
{
	unsigned wdp = (control & WDP3) >> 2 | (control & 7);
	if (wdp > MAX_WDP)
		wdp = MAX_WDP;
	return ((uint64_t)SHORTEST_PERIOD << wdp) * (CHIP_FREQUENCY / OSCILLATOR_HZ);
}

static bool is_on(uint8_t control)
{
	return control & (WDE | WDIE);
}

static avr_cycle_count_t on_time_out(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct watchdog *watchdog = param;
	uint8_t control = avr->data[REG_WDTCSR];
	/* "If the interrupt is not executed before the next time-out, a System
	 * Reset will be applied" (11.9.2). */
	if ((control & WDE) && (!(control & WDIE) || (control & WDIF))) {
		reset_request(watchdog->reset, RESET_WATCHDOG);
		return 0;
	}
	avr_raise_interrupt(avr, &watchdog->stock->watchdog);
	watchdog->counter_start = when;
	return when + period_cycles(control);
}

static void schedule_time_out(struct watchdog *watchdog)
{
	avr_t *avr = watchdog->interrupts->avr;
	uint8_t control = avr->data[REG_WDTCSR];
	avr_cycle_timer_cancel(avr, on_time_out, watchdog);
	if (!is_on(control))
		return;
	chip_call_at(avr, watchdog->counter_start + period_cycles(control), on_time_out, watchdog);
}

/* Called by simavr with each request to its parts, such as `wdr`. Returns -1 for other requests. */
static int on_request(avr_io_t *io, uint32_t request, void *param)
{
	if (request != AVR_IOCTL_WATCHDOG_RESET)
		return -1;
	struct watchdog *watchdog = (struct watchdog *)io;
	watchdog->counter_start = io->avr->cycle + 1; /* `wdr` ends with this cycle */
	schedule_time_out(watchdog);
	return 0;
}

static void write_control(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct watchdog *watchdog = param;
	uint64_t cycle = instruction_store_cycle(watchdog->interrupts->instruction);
	uint8_t old = avr->data[address];
	bool may_change = cycle <= watchdog->change_window_end && !(value & WDCE);
	uint8_t control = (value & WDIE) | (old & WDIF & ~value);
	control |= (may_change ? value : old) & WDP;
	control |= (may_change ? value : value | old) & WDE;
	if (watchdog->reset->mcusr & RESET_WATCHDOG)
		control |= WDE; /* "WDE is overridden by WDRF in MCUSR" (11.9.2) */
	if ((value & WDCE) && (value & WDE))
		watchdog->change_window_end = cycle + CHANGE_WINDOW_CYCLES;
	avr->data[address] = control;
	if (!(control & WDIF))
		watchdog->stock->watchdog.pending = 0; /* a time-out in this cycle requests it again */
	if (!is_on(old))
		watchdog->counter_start = cycle;
	schedule_time_out(watchdog);
	interrupts_request_check(watchdog->interrupts);
}

static uint8_t read_control(avr_t *avr, avr_io_addr_t address, void *param)
{
	const struct watchdog *watchdog = param;
	uint8_t value = avr->data[address];
	return avr->cycle < watchdog->change_window_end ? value | WDCE : value & ~WDCE;
}

/* If WDE and WDIE are set, "Executing the corresponding interrupt vector will clear WDIE and
 * WDIF automatically by hardware (the Watchdog goes to System Reset Mode)" (11.9.2). In
 * interrupt mode this clears only WDIF, which also keeps simavr from clearing WDIE. */
static void on_vector(struct avr_irq_t *irq, uint32_t is_running, void *param)
{
	struct watchdog *watchdog = param;
	uint8_t *control = &watchdog->interrupts->avr->data[REG_WDTCSR];
	if (is_running)
		*control &= *control & WDE ? ~(WDIF | WDIE) : ~WDIF;
}

void watchdog_attach(struct watchdog *watchdog, struct interrupts *interrupts, struct reset *reset)
{
	avr_t *avr = interrupts->avr;
	*watchdog = (struct watchdog){
		.io = { .kind = "simulated-uno watchdog", .ioctl = on_request },
		.interrupts = interrupts,
		.reset = reset,
		.stock = (avr_watchdog_t *)chip_find_peripheral(avr, "watchdog"),
	};
	avr_register_io(avr, &watchdog->io); /* precedes simavr's own watchdog in the list */
	hook_read_and_write(avr, REG_WDTCSR, read_control, write_control, watchdog);
	avr_irq_register_notify(watchdog->stock->watchdog.irq + AVR_INT_IRQ_RUNNING, on_vector,
	                        watchdog);
}

void watchdog_reset(struct watchdog *watchdog)
{
	avr_t *avr = watchdog->interrupts->avr;
	watchdog->change_window_end = 0;
	watchdog->counter_start = avr->cycle;
	avr->data[REG_WDTCSR] = watchdog->reset->mcusr & RESET_WATCHDOG ? WDE : 0;
	schedule_time_out(watchdog);
}

bool watchdog_may_reset(const struct watchdog *watchdog)
{
	return watchdog->interrupts->avr->data[REG_WDTCSR] & WDE;
}
