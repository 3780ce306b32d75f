/* One simulated UNO: connects its parts, and runs the loop that executes instructions.
 *
 * The loop never waits for the wall clock. A run ends at the requested cycle, even if the CPU
 * sleeps and simavr's next event is later: then uno->now is ahead of avr->cycle. Therefore
 * several short runs have exactly the result of one long run.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "uno.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <simavr/avr_extint.h>
#include <simavr/sim_core.h>

#include "board.h"
#include "restart.h"

/* The largest number of cycles that simavr runs without returning to the loop. A run may end late
 * by as much. */
#define MAX_SLICE_CYCLES 256

static void on_log(avr_t *avr, const int level, const char *format, va_list args)
{
	struct uno *uno = avr ? avr->custom.data : NULL;
	if (uno && level <= LOG_ERROR)
		vsnprintf(uno->error_message, sizeof uno->error_message, format, args);
}

/* While D2 or D3 is low, simavr polls it on every cycle, in case the firmware uses a level
 * interrupt. This function switches the polling off, because it is slow. */
static void disable_level_polling(avr_t *avr)
{
	avr_extint_set_strict_lvl_trig(avr, 0, 0);
	avr_extint_set_strict_lvl_trig(avr, 1, 0);
}

static void on_reset(struct avr_io_t *io)
{
	struct uno *uno = (struct uno *)((char *)io - offsetof(struct uno, io));
	disable_level_polling(uno->avr);
	uno->handlers.depth = 0;
	uno->call_timer.is_in_call = false;
	if (uno->follows_data_sheet) {
		uno->timer1.temp = 0;
		usart_reset(&uno->usart);
		eeprom_reset(&uno->eeprom);
		adc_reset(&uno->adc);
		if (!uno->supply.holds_reset)
			watchdog_reset(&uno->watchdog);
	}
	supply_rearm_timers(&uno->supply);
	sender_reset(&uno->sender, uno->now);
}

void uno_set_logger(void)
{
	avr_global_logger_set(on_log);
}

/* Appends `io` to simavr's list of parts, so that our reset runs after all others. */
static void join_reset_chain(avr_t *avr, avr_io_t *io)
{
	io->kind = "simulated-uno";
	io->avr = avr;
	io->reset = on_reset;
	avr_io_t **link = &avr->io_port;
	while (*link)
		link = &(*link)->next;
	*link = io;
}

/* simavr reports a store beyond SRAM as a crash, but only after the store. Therefore the data space
 * gets all 64 KiB that an AVR can address. */
static void widen_data_space(avr_t *avr)
{
	size_t size = avr->ramend + 1;
	avr->data = realloc(avr->data, UINT16_MAX + 1);
	if (!avr->data)
		abort();
	memset(avr->data + size, 0, UINT16_MAX + 1 - size);
}

struct uno *uno_new(bool follows_data_sheet, double baud)
{
	struct uno *uno = calloc(1, sizeof *uno);
	avr_t *avr = avr_make_mcu_by_name("atmega328p");
	if (!uno || !avr)
		abort(); /* out of memory, or a libsimavr without the UNO's chip */
	avr->custom.data = uno;
	avr_init(avr);
	/* Also before the first reset, which would drop the timer of a poll and so never free the poll. */
	disable_level_polling(avr);
	widen_data_space(avr);
	avr->frequency = CHIP_FREQUENCY;
	avr->vcc = avr->avcc = avr->aref = 5000;
	avr->log = LOG_ERROR;

	uno->avr = avr;
	uno->follows_data_sheet = follows_data_sheet;
	uno->instruction.avr = avr;
	recorder_attach(&uno->recorder, &uno->instruction);
	handlers_attach(&uno->handlers, avr);
	call_timer_attach(&uno->call_timer, &uno->handlers);
	uno->disturbance = (struct disturbance){ .avr = avr, .handlers = &uno->handlers };
	serial_record_init(&uno->transmitted);
	stock_uart_attach(&uno->stock_uart, &uno->instruction, &uno->transmitted);
	struct receiver receiver = stock_uart_receiver(&uno->stock_uart);
	reset_attach(&uno->reset, avr, follows_data_sheet);
	eeprom_attach(&uno->eeprom, avr);
	adc_attach(&uno->adc, avr);
	contacts_attach(&uno->contacts, avr);
	supply_attach(&uno->supply, &uno->reset, &uno->eeprom);
	if (follows_data_sheet) {
		interrupts_attach(&uno->interrupts, &uno->instruction);
		timer1_attach(&uno->timer1, avr);
		pin_toggle_attach(&uno->pin_toggle, &uno->instruction);
		usart_attach(&uno->usart, &uno->interrupts, &uno->stock_uart);
		receiver = usart_receiver(&uno->usart);
		eeprom_correct(&uno->eeprom, &uno->interrupts, &uno->reset);
		adc_correct(&uno->adc, &uno->interrupts, &uno->supply);
		watchdog_attach(&uno->watchdog, &uno->interrupts, &uno->reset);
	}
	sender_attach(&uno->sender, avr, receiver, baud);
	join_reset_chain(avr, &uno->io);
	restart(uno, RESET_POWER_ON);
	return uno;
}

/* Frees the irqs that avr_terminate leaves: those of the I/O registers and of the interrupt vectors. */
static void free_irqs(avr_t *avr)
{
	for (size_t i = 0; i < ARRAY_SIZE(avr->io); i++)
		avr_free_irq(avr->io[i].irq, AVR_IOMEM_IRQ_ALL + 1);
	for (int i = 0; i < avr->irq_pool.count; i++)
		avr_free_irq(avr->irq_pool.irq[i], 1);
	free(avr->irq_pool.irq);
}

void uno_free(struct uno *uno)
{
	avr_terminate(uno->avr);
	free_irqs(uno->avr);
	free(uno->avr);
	const struct list *lists[] = {
		&uno->recorder.edges, &uno->recorder.marks, &uno->call_timer.calls,
		&uno->transmitted.bytes, &uno->sender.delivered.bytes, &uno->sender.queue,
		&uno->sender.flood, &uno->reset.events, &uno->eeprom.operations,
	};
	for (size_t i = 0; i < ARRAY_SIZE(lists); i++)
		free(lists[i]->items);
	free(uno);
}

void uno_set_program_bounds(struct uno *uno, uint32_t code_end, uint16_t data_end)
{
	uno->avr->codeend = code_end;
	uno->data_end = data_end;
}

/* The first SRAM address after static data that no longer contains its noise. */
uint16_t uno_lowest_stack_address(const struct uno *uno)
{
	uint16_t address = uno->data_end;
	while (address < CHIP_SRAM_END && uno->avr->data[address] == uno->reset.initial_sram[address])
		address++;
	return address;
}

static void run_instructions(struct uno *uno, uint64_t until)
{
	avr_t *avr = uno->avr;
	if (uno->call_timer.is_enabled)
		call_timer_check(&uno->call_timer);
	bool is_stepping = uno->call_timer.is_enabled || disturbance_is_active(&uno->disturbance);
	uint64_t max_cycles = is_stepping || until <= avr->cycle ? 1 : until - avr->cycle;
	avr->run_cycle_limit = max_cycles < MAX_SLICE_CYCLES ? max_cycles : MAX_SLICE_CYCLES;
	/* The count that simavr computed from the old limit may extend beyond `until`. */
	if (avr->run_cycle_count > avr->run_cycle_limit)
		avr->run_cycle_count = avr->run_cycle_limit;
	instruction_run(&uno->instruction);
}

/* Sleeps for `cycles`, until simavr's next timer. Returns false, without sleeping, if the timer is
 * due after `until`. In the stock fidelity, the CPU wakes a cycle late, as in simavr. */
static bool sleep_until_timer(struct uno *uno, uint64_t cycles, uint64_t until)
{
	avr_t *avr = uno->avr;
	cycles += uno->follows_data_sheet ? 0 : 1;
	if (avr->cycle + cycles > until)
		return false;
	avr->cycle += cycles;
	uno->sleep_cycles += cycles;
	uno->interrupts.ends_sleep = true;
	return true;
}

static void serve_interrupts(struct uno *uno)
{
	avr_t *avr = uno->avr;
	if (!uno->follows_data_sheet) {
		if (avr->interrupt_state)
			avr_service_interrupts(avr);
	} else if (avr->interrupt_state || uno->interrupts.needs_check) {
		if (interrupts_serve(&uno->interrupts))
			avr_cycle_timer_process(avr); /* the entry took cycles, so a timer may be due */
	}
}

/* True if interrupts are disabled in the sleeping CPU and no reset can wake it. */
static bool is_halted(const struct uno *uno)
{
	if (uno->avr->sreg[S_I])
		return false;
	return !uno->follows_data_sheet ||
	       !(watchdog_may_reset(&uno->watchdog) || supply_may_reset(&uno->supply));
}

/* Keeps the CPU asleep if interrupts are disabled: in simavr, an interrupt whose enable bit is set
 * wakes it anyway. */
static void stay_asleep(avr_t *avr)
{
	if (avr->state == cpu_Running && !avr->sreg[S_I])
		avr->state = cpu_Sleeping;
}

/* Executes a few instructions, or advances the clock while the CPU cannot execute any. Returns
 * false if the power is off or nothing happens before cycle `until`. `normal_run`: the value of
 * avr->run unless stock simavr's watchdog requests a reset. */
static bool step(struct uno *uno, avr_run_t normal_run, uint64_t until)
{
	avr_t *avr = uno->avr;
	if (restart_if_requested(uno))
		return !uno->is_powered_off;
	if (uno->supply.holds_reset) {
		restart_advance_in_reset(uno, until);
		return true;
	}
	if (avr->state == cpu_Sleeping)
		disturbance_serve(&uno->disturbance);
	if (avr->state == cpu_Running && disturbance_stalls_main(&uno->disturbance)) {
		disturbance_advance_stall(&uno->disturbance, until);
	} else if (avr->state == cpu_Running) {
		uno->interrupts.ends_sleep = false;
		/* simavr's own order: instruction, timers, interrupts. */
		run_instructions(uno, until);
	}
	bool was_asleep = avr->state == cpu_Sleeping;
	uint64_t cycles_to_timer = avr_cycle_timer_process(avr);
	/* Stock simavr's watchdog requests a reset by replacing avr->run with a call of avr_reset. */
	if (avr->run != normal_run) {
		restart(uno, RESET_WATCHDOG);
		avr->run = normal_run;
		return true;
	}
	if (was_asleep)
		stay_asleep(avr);
	if (avr->state == cpu_Sleeping) {
		if (is_halted(uno)) {
			avr->state = cpu_Done;
			return true;
		}
		if (!sleep_until_timer(uno, cycles_to_timer, until))
			return false;
		if (uno->follows_data_sheet) {
			avr_cycle_timer_process(avr); /* fires the timer that is due now */
			stay_asleep(avr);
		}
	}
	disturbance_serve(&uno->disturbance);
	serve_interrupts(uno);
	return true;
}

enum stop_reason uno_run(struct uno *uno, uint64_t until, bool stops_at_line)
{
	avr_t *avr = uno->avr;
	avr_run_t normal_run = avr->run;
	if (until < uno->now)
		until = uno->now; /* time never goes back */
	uno->transmitted.has_line_ended = false;
	while (avr->cycle < until && !uno->is_powered_off) {
		if (avr->state != cpu_Running && avr->state != cpu_Sleeping)
			break;
		if (!step(uno, normal_run, until))
			break;
		if (uno->transmitted.has_line_ended && stops_at_line)
			break;
	}
	restart_if_requested(uno); /* requested in the last cycle */
	bool stopped_at_line = uno->transmitted.has_line_ended && stops_at_line;
	bool is_alive = avr->state == cpu_Running || avr->state == cpu_Sleeping;
	/* The CPU sleeps and nothing is due before `until`, so `until` is the current cycle, ahead
	 * of simavr's. */
	bool is_simavr_behind = is_alive && !stopped_at_line && !uno->is_powered_off &&
	                        avr->cycle < until;
	uno->now = is_simavr_behind ? until : avr->cycle;
	if (uno->is_powered_off)
		return STOP_POWER_CUT;
	if (avr->state == cpu_Done)
		return STOP_HALTED;
	if (!is_alive)
		return STOP_CRASHED;
	return stopped_at_line ? STOP_LINE_SENT : STOP_CYCLE_REACHED;
}

uint64_t uno_sleep_cycles(const struct uno *uno)
{
	bool is_simavr_behind = uno->now > uno->avr->cycle;
	return uno->sleep_cycles + (is_simavr_behind ? uno->now - uno->avr->cycle : 0);
}

void uno_time_calls(struct uno *uno, bool is_enabled, uint32_t entry_address)
{
	uno->call_timer.is_enabled = is_enabled;
	uno->call_timer.is_in_call = false;
	uno->call_timer.entry_address = entry_address;
}

void uno_send(struct uno *uno, const uint8_t *bytes, size_t length, bool is_stop_bit_low)
{
	sender_send(&uno->sender, bytes, length, is_stop_bit_low, uno->now);
}

void uno_set_flood(struct uno *uno, const uint8_t *bytes, size_t length)
{
	sender_set_flood(&uno->sender, bytes, length, uno->now);
}

void uno_block_cpu(struct uno *uno, uint64_t cycles)
{
	avr_t *avr = uno->avr;
	uno->disturbance.foreign_cycles_left = cycles;
	if (avr->state != cpu_Sleeping)
		return; /* served by the loop, as soon as interrupts are enabled */
	restart_catch_up(uno);
	disturbance_serve(&uno->disturbance);
	uno->now = avr->cycle;
}

void uno_stall_main(struct uno *uno, uint64_t until)
{
	uno->disturbance.stalled_until = until;
}

void uno_poke(struct uno *uno, uint16_t address, uint8_t value)
{
	restart_catch_up(uno);
	chip_store(uno->avr, address, value);
}

void uno_set_baud(struct uno *uno, double baud) { sender_set_baud(&uno->sender, baud); }
uint32_t uno_cycles_per_bit(const struct uno *uno) { return usart_cycles_per_bit(uno->avr); }
size_t uno_unsent_count(const struct uno *uno) { return sender_unsent_count(&uno->sender); }
uint64_t uno_sent_count(const struct uno *uno) { return uno->sender.sent_count; }
uint64_t uno_now(const struct uno *uno) { return uno->now; }
uint32_t uno_pc(const struct uno *uno) { return uno->avr->pc; }
uint64_t uno_watchdog_reset_count(const struct uno *uno) { return uno->watchdog_reset_count; }
uint64_t uno_overrun_count(const struct uno *uno) { return uno->usart.overrun_count; }
uint32_t uno_pin_levels(const struct uno *uno) { return uno->recorder.levels; }
const char *uno_error_message(const struct uno *uno) { return uno->error_message; }
const uint8_t *uno_data(const struct uno *uno) { return uno->avr->data; }
const struct vector_stats *uno_vectors(const struct uno *uno) { return uno->handlers.vectors; }
struct list *uno_edges(struct uno *uno) { return &uno->recorder.edges; }
struct list *uno_marks(struct uno *uno) { return &uno->recorder.marks; }
struct list *uno_transmitted(struct uno *uno) { return &uno->transmitted.bytes; }
struct list *uno_received(struct uno *uno) { return &uno->sender.delivered.bytes; }
struct list *uno_calls(struct uno *uno) { return &uno->call_timer.calls; }
