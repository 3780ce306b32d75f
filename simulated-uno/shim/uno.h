/* The parts of one simulated UNO that the shim's files share.
 *
 * simulated-uno: an Arduino UNO on libsimavr, for tests.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#ifndef UNO_H
#define UNO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>

#define UNO_FREQUENCY 16000000u
#define UNO_VECTORS 26    /* vectors of an ATmega328P, reset included */
#define UNO_FLASH_WORDS 16384

/* I/O registers of the ATmega328P that the shim corrects, as data addresses. */
enum {
	REG_PINB = 0x23, REG_PINC = 0x26, REG_PIND = 0x29,
	REG_TIFR0 = 0x35, REG_TIFR1 = 0x36, REG_TIFR2 = 0x37,
	REG_GPIOR0 = 0x3e,
	REG_PCICR = 0x68, REG_EIMSK = 0x3d,
	REG_TIMSK0 = 0x6e, REG_TIMSK1 = 0x6f, REG_TIMSK2 = 0x70,
	REG_TCNT1L = 0x84, REG_ICR1L = 0x86, REG_OCR1AL = 0x88, REG_OCR1BL = 0x8a,
	REG_UCSR0A = 0xc0, REG_UCSR0B = 0xc1, REG_UCSR0C = 0xc2,
	REG_UBRR0L = 0xc4, REG_UBRR0H = 0xc5, REG_UDR0 = 0xc6,
};

/* A list that grows; the caller reads items and count, and may set count to 0. */
struct list {
	void *items;
	size_t count, room, size;
};

struct edge { uint64_t cycle; uint8_t pin, level; };
struct stamped_byte { uint64_t cycle; uint8_t byte; };
struct call { uint64_t enter, leave, interrupted; };
struct vector_use { uint64_t entries, cycles; };

/* What ended a run. Kept in step with `Stop` in src/ffi.rs. */
enum stop { STOP_TIME, STOP_LINE, STOP_HALTED, STOP_CRASHED };

/* The person at the other end of the cable: sends without pause at its own
 * baud rate for as long as it has bytes, as a PC does. */
struct sender {
	double cycles_per_bit;
	double line_free;           /* cycle at which the last stop bit ends */
	struct list queue;          /* uint8_t */
	size_t next;                /* first unsent byte of the queue */
	uint8_t *flood;             /* sent over and over once the queue is empty */
	size_t flood_length, flood_next;
	uint64_t sent;
	uint8_t byte;               /* on the line now */
	bool busy;
};

/* USART0 by the data sheet; idle in the stock fidelity. */
struct usart {
	uint8_t fifo[2];
	bool fifo_frame_error[2];
	uint8_t held;               /* complete byte that waits in the shift register */
	bool held_frame_error;
	uint8_t count;              /* bytes in fifo, 0..2 */
	bool holding, overrun;
	uint8_t transmitting, next;
	bool busy, next_full;
	uint64_t overruns;
};

struct uno {
	avr_t *avr;
	avr_io_t io;                /* our place in simavr's reset chain */
	avr_uart_t *stock_uart;
	bool data_sheet;

	uint64_t now;               /* time reached; ahead of avr->cycle only while asleep */
	uint64_t asleep;            /* cycles spent asleep */
	uint64_t resets;            /* resets after power-on (watchdog) */
	bool executing;             /* inside an instruction, not inside a timer */
	bool slept;                 /* the interrupt about to be served ended a sleep */
	bool recheck;               /* an enable bit changed: look at all flags again */
	bool stop_at_line, line_seen;
	uint16_t data_end;          /* first SRAM address after static data */

	uint16_t pins;              /* recorded pins, bit n = Dn */
	uint16_t levels;
	struct list edges;          /* struct edge */
	struct list received;       /* struct stamped_byte, UNO -> host */
	struct list heard;          /* struct stamped_byte, host -> UNO, complete */
	struct list marks;          /* struct stamped_byte, writes to GPIOR0 */

	struct sender sender;
	struct usart usart;
	uint8_t temp;               /* TEMP of Timer1's 16-bit registers */
	avr_io_write_t timer1_low[4];
	void *timer1_low_param[4];
	avr_io_read_t tcnt_read;
	void *tcnt_read_param;
	avr_io_write_t pin_write[3];
	void *pin_write_param[3];

	struct vector_use vectors[UNO_VECTORS];
	uint8_t running[16];        /* nested handlers */
	uint8_t depth;
	uint64_t running_since;
	uint64_t in_handlers;       /* cycles in handlers, finished ones */

	bool watching;              /* a function is being timed: step one by one */
	uint32_t watch_entry;       /* byte address in flash */
	uint32_t watch_return;
	uint16_t watch_sp;
	bool watch_inside;
	uint64_t watch_since, watch_handlers;
	struct list calls;          /* struct call */

	char message[256];          /* simavr's last complaint */
};

void *list_push(struct list *list);

/* Cycle at which the instruction now executing takes effect: its last one.
 * simavr calls back at the first, which would make an `sbi` edge look a cycle
 * early beside an `out` edge. */
uint64_t uno_effect_cycle(const struct uno *uno);
/* What a write to an I/O register really writes: `sbi` touches one bit only,
 * but simavr turns it into a read and a write of all eight. */
uint8_t uno_written_bits(const struct uno *uno, uint8_t value);
/* Cycles spent in interrupt handlers up to now. */
uint64_t uno_handler_cycles(const struct uno *uno);
void uno_note_handler(struct uno *uno, uint8_t vector);

void sender_wake(struct uno *uno);

void datasheet_attach(struct uno *uno);
/* Serves the highest enabled interrupt. True if cycles passed. */
bool datasheet_service_interrupts(struct uno *uno);

void usart_attach(struct uno *uno);
void usart_reset(struct uno *uno);
void usart_start_bit(struct uno *uno);
void usart_receive(struct uno *uno, uint8_t byte, double sender_cycles_per_bit);

#endif
