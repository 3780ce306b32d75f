/* One simulated UNO: creation, the hot loop, and what it records.
 *
 * The loop never waits for the wall clock, and stops at a cycle, not at a
 * simavr event: while the CPU sleeps, simulated time may be ahead of
 * avr->cycle, so a run cut into pieces gives the same bits as one long run.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "uno.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <simavr/avr_extint.h>
#include <simavr/avr_ioport.h>
#include <simavr/sim_core.h>

#define SLICE 256  /* most cycles simavr runs on its own: a run ends this exactly */
#define PAINT 0xc5 /* fills unused SRAM, so that the stack's lowest mark shows */

void *list_push(struct list *list)
{
	if (list->count == list->room) {
		list->room = list->room ? list->room * 2 : 1024;
		list->items = realloc(list->items, list->room * list->size);
		if (!list->items)
			abort();
	}
	return (char *)list->items + list->size * list->count++;
}

static uint16_t opcode_at_pc(const struct uno *uno)
{
	const uint8_t *flash = uno->avr->flash + uno->avr->pc;
	return flash[0] | flash[1] << 8;
}

uint64_t uno_effect_cycle(const struct uno *uno)
{
	if (!uno->executing)
		return uno->avr->cycle;
	bool is_out = (opcode_at_pc(uno) & 0xf800) == 0xb800;
	return uno->avr->cycle + (is_out ? 1 : 2); /* sbi, cbi, st, sts: 2 cycles */
}

uint8_t uno_written_bits(const struct uno *uno, uint8_t value)
{
	uint16_t opcode = opcode_at_pc(uno);
	bool is_sbi = uno->executing && (opcode & 0xff00) == 0x9a00;
	return is_sbi ? 1 << (opcode & 7) : value;
}

static void on_pin(struct avr_irq_t *irq, uint32_t value, void *param)
{
	struct uno *uno = param;
	/* Port D's irq numbers are D0..D7, port B's are D8..D13. */
	uint8_t pin = irq->irq + (strstr(irq->name, "portb") ? 8 : 0);
	uint16_t bit = 1 << pin;
	uint8_t level = value & 1;
	if (!(uno->pins & bit) || level == !!(uno->levels & bit))
		return;
	uno->levels ^= bit;
	struct edge *edge = list_push(&uno->edges);
	*edge = (struct edge){ uno_effect_cycle(uno), pin, level };
}

static void on_stock_transmit(struct avr_irq_t *irq, uint32_t value, void *param)
{
	(void)irq;
	struct uno *uno = param;
	struct stamped_byte *byte = list_push(&uno->received);
	*byte = (struct stamped_byte){ uno_effect_cycle(uno), value };
	uno->line_seen |= value == '\n';
}

static void on_mark(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct uno *uno = param;
	avr->data[addr] = value;
	struct stamped_byte *mark = list_push(&uno->marks);
	*mark = (struct stamped_byte){ uno_effect_cycle(uno), value };
}

uint64_t uno_handler_cycles(const struct uno *uno)
{
	return uno->in_handlers + (uno->depth ? uno->avr->cycle - uno->running_since : 0);
}

/* vector > 0: a handler begins; 0: the innermost one ends. */
void uno_note_handler(struct uno *uno, uint8_t vector)
{
	/* simavr tells before it counts the 4 cycles of `reti`. */
	uint64_t cycle = uno->avr->cycle + (vector ? 0 : 4);
	if (uno->depth) {
		uint64_t spent = cycle - uno->running_since;
		uno->in_handlers += spent;
		uno->vectors[uno->running[uno->depth - 1]].cycles += spent;
	}
	uno->running_since = cycle;
	if (!vector) {
		if (uno->depth)
			uno->depth--;
	} else if (vector < UNO_VECTORS && uno->depth < sizeof uno->running) {
		uno->vectors[vector].entries++;
		uno->running[uno->depth++] = vector;
	}
}

static void on_vector(struct avr_irq_t *irq, uint32_t running, void *param)
{
	uno_note_handler(param, running ? irq->irq / 256 : 0);
}

static void on_log(avr_t *avr, const int level, const char *format, va_list args)
{
	struct uno *uno = avr ? avr->custom.data : NULL;
	if (uno && level <= LOG_ERROR)
		vsnprintf(uno->message, sizeof uno->message, format, args);
}

/* simavr polls D2 and D3 on every cycle while they are low, in case the
 * firmware wants a level interrupt. D3 is a servo here: switch that off. */
static void no_level_polling(avr_t *avr)
{
	avr_extint_set_strict_lvl_trig(avr, 0, 0);
	avr_extint_set_strict_lvl_trig(avr, 1, 0);
}

static void on_reset(struct avr_io_t *io)
{
	struct uno *uno = (struct uno *)((char *)io - offsetof(struct uno, io));
	no_level_polling(uno->avr);
	uno->depth = 0;
	uno->watch_inside = false;
	uno->sender.busy = false; /* simavr's reset drops all timers, ours too */
	if (uno->data_sheet)
		usart_reset(uno);
	sender_wake(uno);
}

void uno_set_logger(void)
{
	avr_global_logger_set(on_log);
}

struct uno *uno_new(bool data_sheet, uint16_t pins, double baud)
{
	struct uno *uno = calloc(1, sizeof *uno);
	avr_t *avr = avr_make_mcu_by_name("atmega328p");
	if (!uno || !avr)
		abort(); /* out of memory, or a libsimavr without the UNO's chip */
	uno->avr = avr;
	uno->data_sheet = data_sheet;
	uno->pins = pins;
	uno->edges.size = sizeof(struct edge);
	uno->received.size = uno->heard.size = uno->marks.size = sizeof(struct stamped_byte);
	uno->calls.size = sizeof(struct call);
	uno->sender.queue.size = 1;
	uno->sender.cycles_per_bit = UNO_FREQUENCY / baud;
	avr->custom.data = uno;
	avr_init(avr);
	avr->frequency = UNO_FREQUENCY;
	avr->vcc = avr->avcc = avr->aref = 5000;
	avr->log = LOG_ERROR;

	for (int bit = 0; bit < 8; bit++) {
		avr_irq_register_notify(
			avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('D'), bit), on_pin, uno);
		if (bit < 6)
			avr_irq_register_notify(
				avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('B'), bit), on_pin, uno);
	}
	for (int v = 0; v < avr->interrupts.vector_count; v++)
		avr_irq_register_notify(
			avr->interrupts.vector[v]->irq + AVR_INT_IRQ_RUNNING, on_vector, uno);
	avr_register_io_write(avr, REG_GPIOR0, on_mark, uno);

	uno->stock_uart = avr->io[AVR_DATA_TO_IO(REG_UDR0)].r.param;
	uint32_t flags = 0; /* no usleep in polling loops, no echo to stdout */
	avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
	avr_irq_register_notify(
		avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
		on_stock_transmit, uno);
	if (data_sheet) {
		datasheet_attach(uno);
		usart_attach(uno);
	}

	/* Last in the chain, so that our reset has the final word. */
	uno->io.kind = "simulated-uno";
	uno->io.avr = avr;
	uno->io.reset = on_reset;
	avr_io_t **link = &avr->io_port;
	while (*link)
		link = &(*link)->next;
	*link = &uno->io;
	on_reset(&uno->io);
	return uno;
}

void uno_free(struct uno *uno)
{
	avr_terminate(uno->avr);
	free(uno->avr);
	free(uno->edges.items);
	free(uno->received.items);
	free(uno->heard.items);
	free(uno->marks.items);
	free(uno->calls.items);
	free(uno->sender.queue.items);
	free(uno->sender.flood);
	free(uno);
}

bool uno_load(struct uno *uno, const uint8_t *code, uint32_t size, uint32_t address)
{
	if (size > uno->avr->flashend + 1 || address > uno->avr->flashend + 1 - size)
		return false;
	memcpy(uno->avr->flash + address, code, size);
	return true;
}

/* Ends loading: `code_end` bytes of flash are code, static data ends at
 * `data_end`, and the SRAM after it is painted. */
void uno_power_on(struct uno *uno, uint32_t code_end, uint16_t data_end)
{
	uno->avr->codeend = code_end;
	uno->data_end = data_end;
	memset(uno->avr->data + data_end, PAINT, uno->avr->ramend + 1 - data_end);
}

/* Lowest SRAM address that the stack has ever touched. */
uint16_t uno_stack_low(const struct uno *uno)
{
	uint16_t address = uno->data_end;
	while (address <= uno->avr->ramend && uno->avr->data[address] == PAINT)
		address++;
	return address;
}

/* Notes entry to and return from the watched function. */
static void watch(struct uno *uno)
{
	avr_t *avr = uno->avr;
	uint16_t sp = avr->data[R_SPL] | avr->data[R_SPH] << 8;
	if (uno->watch_inside && avr->pc == uno->watch_return && sp == uno->watch_sp + 2) {
		struct call *call = list_push(&uno->calls);
		uint64_t handlers = uno_handler_cycles(uno) - uno->watch_handlers;
		*call = (struct call){ uno->watch_since, avr->cycle, handlers };
		uno->watch_inside = false;
	} else if (!uno->watch_inside && avr->pc == uno->watch_entry) {
		uno->watch_return = (avr->data[sp + 1] << 8 | avr->data[sp + 2]) << 1;
		uno->watch_sp = sp;
		uno->watch_since = avr->cycle;
		uno->watch_handlers = uno_handler_cycles(uno);
		uno->watch_inside = true;
	}
}

static void run_instructions(struct uno *uno, uint64_t until)
{
	avr_t *avr = uno->avr;
	if (uno->watching) {
		watch(uno);
		avr->run_cycle_limit = 1;
	} else {
		uint64_t left = until > avr->cycle ? until - avr->cycle : 1;
		avr->run_cycle_limit = left < SLICE ? left : SLICE;
	}
	/* The count that simavr set with the old limit may reach past `until`. */
	if (avr->run_cycle_count > avr->run_cycle_limit)
		avr->run_cycle_count = avr->run_cycle_limit;
	uno->executing = true;
	avr->pc = avr_run_one(avr);
	uno->executing = false;
}

/* Sleeps until simavr's next timer. False if `until` comes first. Stock simavr
 * wakes a cycle late. */
static bool sleep_cycles(struct uno *uno, uint64_t cycles, uint64_t until)
{
	avr_t *avr = uno->avr;
	cycles += uno->data_sheet ? 0 : 1;
	if (avr->cycle + cycles > until)
		return false;
	avr->cycle += cycles;
	uno->asleep += cycles;
	uno->slept = true;
	return true;
}

static void service_interrupts(struct uno *uno)
{
	avr_t *avr = uno->avr;
	if (!uno->data_sheet) {
		if (avr->interrupt_state)
			avr_service_interrupts(avr);
	} else if (avr->interrupt_state || uno->recheck) {
		if (datasheet_service_interrupts(uno))
			avr_cycle_timer_process(avr); /* entering took time */
	}
}

static bool step(struct uno *uno, avr_run_t normal, uint64_t until)
{
	avr_t *avr = uno->avr;
	bool running = avr->state == cpu_Running;
	if (running) {
		uno->slept = false;
		/* One more turn of simavr's order: instruction, timers, interrupts. */
		run_instructions(uno, until);
	}
	uint64_t sleep = avr_cycle_timer_process(avr);
	if (avr->run != normal) { /* the watchdog asks for a reset this way */
		avr->run(avr);
		avr->run = normal;
		uno->resets++;
		return true;
	}
	if (avr->state == cpu_Sleeping) {
		if (!avr->sreg[S_I]) {
			avr->state = cpu_Done;
			return true;
		}
		if (!sleep_cycles(uno, sleep, until))
			return false;
		if (uno->data_sheet)
			avr_cycle_timer_process(avr); /* fires what woke it, now */
	}
	service_interrupts(uno);
	return true;
}

/* Runs until cycle `until`, or the end of the firmware's next line. */
enum stop uno_run(struct uno *uno, uint64_t until)
{
	avr_t *avr = uno->avr;
	avr_run_t normal = avr->run;
	uno->line_seen = false;
	while (avr->cycle < until) {
		if (avr->state != cpu_Running && avr->state != cpu_Sleeping)
			break;
		if (!step(uno, normal, until))
			break;
		if (uno->line_seen && uno->stop_at_line)
			break;
	}
	bool line = uno->line_seen && uno->stop_at_line;
	bool alive = avr->state == cpu_Running || avr->state == cpu_Sleeping;
	/* Asleep and nothing due: the time is `until` though simavr lags. */
	uno->now = alive && !line && avr->cycle < until ? until : avr->cycle;
	if (avr->state == cpu_Done)
		return STOP_HALTED;
	if (!alive)
		return STOP_CRASHED;
	return line ? STOP_LINE : STOP_TIME;
}

/* Cycles asleep up to now, the unfinished sleep included. */
uint64_t uno_asleep(const struct uno *uno)
{
	bool lags = uno->now > uno->avr->cycle;
	return uno->asleep + (lags ? uno->now - uno->avr->cycle : 0);
}

void uno_watch(struct uno *uno, bool on, uint32_t entry)
{
	uno->watching = on;
	uno->watch_entry = entry;
	uno->watch_inside = false;
}

uint64_t uno_now(const struct uno *uno) { return uno->now; }
uint32_t uno_pc(const struct uno *uno) { return uno->avr->pc; }
uint64_t uno_resets(const struct uno *uno) { return uno->resets; }
uint64_t uno_overruns(const struct uno *uno) { return uno->usart.overruns; }
uint16_t uno_levels(const struct uno *uno) { return uno->levels; }
const char *uno_message(const struct uno *uno) { return uno->message; }
const uint8_t *uno_data(const struct uno *uno) { return uno->avr->data; }
uint32_t uno_data_size(const struct uno *uno) { return uno->avr->ramend + 1; }
const struct vector_use *uno_vectors(const struct uno *uno) { return uno->vectors; }
struct list *uno_edges(struct uno *uno) { return &uno->edges; }
struct list *uno_received(struct uno *uno) { return &uno->received; }
struct list *uno_heard(struct uno *uno) { return &uno->heard; }
struct list *uno_marks(struct uno *uno) { return &uno->marks; }
struct list *uno_calls(struct uno *uno) { return &uno->calls; }
void uno_stop_at_line(struct uno *uno, bool on) { uno->stop_at_line = on; }
