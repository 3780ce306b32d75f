/* USART0 of the ATmega328P by its data sheet, chapter 19.
 *
 * simavr 1.6 keeps 64 received bytes and counts 11 bits a frame, which hides
 * every overrun. Here: 10-bit frames at the rate the registers say now, two
 * received bytes and a third in the shift register, the third lost when a
 * fourth begins (DOR), and a transmit buffer of one byte.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "uno.h"

#include <math.h>
#include <string.h>

enum { /* UCSR0A */
	RXC = 1 << 7, TXC = 1 << 6, UDRE = 1 << 5, FE = 1 << 4, DOR = 1 << 3,
	U2X = 1 << 1, MPCM = 1 << 0,
};
enum { /* UCSR0B */
	RXEN = 1 << 4, TXEN = 1 << 3,
};

#define FRAME_BITS 10
#define BAUD_TOLERANCE 0.045 /* a frame's last sample leaves its bit beyond this */

static uint32_t cycles_per_bit(const avr_t *avr)
{
	uint32_t ubrr = avr->data[REG_UBRR0L] | (avr->data[REG_UBRR0H] & 0x0f) << 8;
	return (ubrr + 1) * (avr->data[REG_UCSR0A] & U2X ? 8 : 16);
}

/* Brings RXC, FE and DOR in step with the receive buffer. */
static void show_receiver(struct uno *uno)
{
	avr_t *avr = uno->avr;
	struct usart *usart = &uno->usart;
	uint8_t *a = &avr->data[REG_UCSR0A];
	*a &= ~(RXC | FE | DOR);
	if (usart->count && usart->fifo_frame_error[0])
		*a |= FE;
	if (usart->overrun)
		*a |= DOR;
	if (usart->count)
		avr_raise_interrupt(avr, &uno->stock_uart->rxc); /* sets RXC */
	if (usart->count)
		*a |= RXC; /* also when it is pending already */
}

static void into_fifo(struct usart *usart, uint8_t byte, bool frame_error)
{
	usart->fifo[usart->count] = byte;
	usart->fifo_frame_error[usart->count] = frame_error;
	usart->count++;
}

void usart_start_bit(struct uno *uno)
{
	struct usart *usart = &uno->usart;
	if (!usart->holding)
		return;
	usart->holding = false; /* overwritten by what comes in */
	usart->overrun = true;
	usart->overruns++;
	show_receiver(uno);
}

void usart_receive(struct uno *uno, uint8_t byte, double sender_cycles_per_bit)
{
	struct usart *usart = &uno->usart;
	avr_t *avr = uno->avr;
	if (!(avr->data[REG_UCSR0B] & RXEN))
		return;
	double error = cycles_per_bit(avr) / sender_cycles_per_bit - 1.0;
	bool frame_error = fabs(error) > BAUD_TOLERANCE;
	if (usart->count == 2) {
		usart->held = byte;
		usart->held_frame_error = frame_error;
		usart->holding = true;
	} else {
		into_fifo(usart, byte, frame_error);
	}
	show_receiver(uno);
}

static uint8_t read_data(avr_t *avr, avr_io_addr_t addr, void *param)
{
	(void)addr;
	struct uno *uno = param;
	struct usart *usart = &uno->usart;
	uint8_t byte = usart->fifo[0];
	if (!usart->count)
		return byte;
	usart->fifo[0] = usart->fifo[1];
	usart->fifo_frame_error[0] = usart->fifo_frame_error[1];
	usart->count--;
	usart->overrun = false;
	if (usart->holding) {
		usart->holding = false;
		into_fifo(usart, usart->held, usart->held_frame_error);
	}
	uno->stock_uart->rxc.pending = 0;
	uno->recheck = true;
	show_receiver(uno);
	avr->data[REG_UDR0] = byte;
	return byte;
}

static avr_cycle_count_t sent(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct uno *uno = param;
	struct usart *usart = &uno->usart;
	struct stamped_byte *byte = list_push(&uno->received);
	*byte = (struct stamped_byte){ when, usart->transmitting };
	uno->line_seen |= usart->transmitting == '\n';
	if (usart->next_full) {
		usart->transmitting = usart->next;
		usart->next_full = false;
		avr_raise_interrupt(avr, &uno->stock_uart->udrc);
		return when + FRAME_BITS * cycles_per_bit(avr);
	}
	usart->busy = false;
	avr_raise_interrupt(avr, &uno->stock_uart->txc);
	return 0;
}

static void write_data(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	(void)addr;
	struct uno *uno = param;
	struct usart *usart = &uno->usart;
	if (!(avr->data[REG_UCSR0B] & TXEN) || usart->next_full)
		return; /* ignored by the transmitter */
	if (!usart->busy) {
		usart->busy = true;
		usart->transmitting = value;
		avr_cycle_timer_register(avr, FRAME_BITS * cycles_per_bit(avr), sent, uno);
	} else {
		usart->next = value;
		usart->next_full = true;
		avr->data[REG_UCSR0A] &= ~UDRE;
		uno->stock_uart->udrc.pending = 0;
	}
}

static void write_status(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	(void)addr;
	struct uno *uno = param;
	uint8_t *a = &avr->data[REG_UCSR0A];
	if (value & TXC) {
		*a &= ~TXC;
		uno->stock_uart->txc.pending = 0;
	}
	*a = (*a & ~(U2X | MPCM)) | (value & (U2X | MPCM));
}

static uint8_t read_status(avr_t *avr, avr_io_addr_t addr, void *param)
{
	(void)param;
	return avr->data[addr];
}

static void write_control(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct uno *uno = param;
	avr->data[addr] = value;
	if (!(value & RXEN)) {
		uno->usart.count = 0;
		uno->usart.holding = uno->usart.overrun = false;
		show_receiver(uno);
	}
	uno->recheck = true; /* enabling an interrupt whose flag is up fires it */
}

static void write_plain(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	(void)param;
	avr->data[addr] = value;
}

void usart_reset(struct uno *uno)
{
	avr_t *avr = uno->avr;
	uint64_t overruns = uno->usart.overruns;
	uno->usart = (struct usart){ .overruns = overruns };
	avr_cycle_timer_cancel(avr, sent, uno);
	avr->data[REG_UCSR0A] = UDRE;
	avr->data[REG_UCSR0B] = 0;
	avr->data[REG_UCSR0C] = 0x06;
}

void usart_attach(struct uno *uno)
{
	avr_t *avr = uno->avr;
	struct { uint16_t addr; avr_io_read_t read; avr_io_write_t write; } hooks[] = {
		{ REG_UDR0, read_data, write_data },
		{ REG_UCSR0A, read_status, write_status },
		{ REG_UCSR0B, NULL, write_control },
		{ REG_UBRR0L, NULL, write_plain },
	};
	/* Straight into simavr's table: its own registration refuses to override. */
	for (size_t i = 0; i < sizeof hooks / sizeof *hooks; i++) {
		avr_io_addr_t io = AVR_DATA_TO_IO(hooks[i].addr);
		avr->io[io].r.c = hooks[i].read;
		avr->io[io].r.param = uno;
		avr->io[io].w.c = hooks[i].write;
		avr->io[io].w.param = uno;
	}
}
