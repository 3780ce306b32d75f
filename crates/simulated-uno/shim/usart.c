/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "usart.h"

#include <math.h>

enum { /* UCSR0A */
	RXC = 1 << 7, TXC = 1 << 6, UDRE = 1 << 5, FE = 1 << 4, DOR = 1 << 3,
	U2X = 1 << 1, MPCM = 1 << 0,
};
enum { /* UCSR0B */
	RXEN = 1 << 4, TXEN = 1 << 3,
};

#define DATA_BITS 8
#define FRAME_BITS 10
#define BAUD_TOLERANCE 0.045 /* a frame's last sample leaves its bit beyond this */

uint32_t usart_cycles_per_bit(const avr_t *avr)
{
	uint32_t ubrr = avr->data[REG_UBRR0L] | (avr->data[REG_UBRR0H] & 0x0f) << 8;
	return (ubrr + 1) * (avr->data[REG_UCSR0A] & U2X ? 8 : 16);
}

uint8_t usart_sampled(uint8_t byte, double ratio)
{
	uint32_t line = 1u << (DATA_BITS + 1) | (uint32_t)byte << 1; /* stop bit, data, start bit */
	uint8_t sampled = 0;
	for (int bit = 0; bit < DATA_BITS; bit++) {
		double at = (bit + 1.5) * ratio;
		if (at >= FRAME_BITS || line >> (int)at & 1)
			sampled |= 1 << bit;
	}
	return sampled;
}

/* Brings RXC, FE and DOR in step with the receive buffer. */
static void show_receiver(struct usart *usart)
{
	avr_t *avr = usart->avr;
	uint8_t *a = &avr->data[REG_UCSR0A];
	*a &= ~(RXC | FE | DOR);
	if (usart->count && usart->received[0].frame_error)
		*a |= FE;
	if (usart->overrun)
		*a |= DOR;
	if (usart->count) {
		avr_raise_interrupt(avr, &usart->vectors->rxc); /* sets RXC */
		*a |= RXC; /* also when it is pending already */
	}
}

static void start_bit(void *param)
{
	struct usart *usart = param;
	if (usart->count < RECEIVED)
		return;
	usart->count--; /* the incoming byte overwrites the shift register */
	usart->overrun = true;
	usart->overruns++;
	show_receiver(usart);
}

static uint8_t receive(void *param, struct line_byte byte, double sender_cycles_per_bit)
{
	struct usart *usart = param;
	const avr_t *avr = usart->avr;
	if (!(avr->data[REG_UCSR0B] & RXEN))
		return byte.value;
	double ratio = usart_cycles_per_bit(avr) / sender_cycles_per_bit;
	bool frame_error = byte.stop_low || fabs(ratio - 1.0) > BAUD_TOLERANCE;
	uint8_t value = usart_sampled(byte.value, ratio);
	usart->received[usart->count++] = (struct received){ value, frame_error };
	show_receiver(usart);
	return frame_error ? 0xff : value;
}

static uint8_t read_data(avr_t *avr, avr_io_addr_t addr, void *param)
{
	struct usart *usart = param;
	uint8_t byte = usart->received[0].value;
	if (!usart->count)
		return byte;
	usart->count--;
	for (int i = 0; i < usart->count; i++)
		usart->received[i] = usart->received[i + 1];
	usart->overrun = false;
	usart->vectors->rxc.pending = 0;
	interrupts_changed(usart->interrupts);
	show_receiver(usart);
	avr->data[REG_UDR0] = byte;
	return byte;
}

static avr_cycle_count_t sent(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct usart *usart = param;
	serial_bytes_push(usart->transmitted, when, usart->transmitting);
	if (usart->next_full) {
		usart->transmitting = usart->next;
		usart->next_full = false;
		avr_raise_interrupt(avr, &usart->vectors->udrc);
		return when + FRAME_BITS * usart_cycles_per_bit(avr);
	}
	usart->busy = false;
	avr_raise_interrupt(avr, &usart->vectors->txc);
	return 0;
}

static void write_data(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct usart *usart = param;
	if (!(avr->data[REG_UCSR0B] & TXEN) || usart->next_full)
		return; /* ignored by the transmitter */
	if (!usart->busy) {
		usart->busy = true;
		usart->transmitting = value;
		avr_cycle_timer_register(avr, FRAME_BITS * usart_cycles_per_bit(avr), sent, usart);
	} else {
		usart->next = value;
		usart->next_full = true;
		avr->data[REG_UCSR0A] &= ~UDRE;
		usart->vectors->udrc.pending = 0;
	}
}

static void write_status(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct usart *usart = param;
	uint8_t *a = &avr->data[REG_UCSR0A];
	if (value & TXC) {
		*a &= ~TXC;
		usart->vectors->txc.pending = 0;
	}
	*a = (*a & ~(U2X | MPCM)) | (value & (U2X | MPCM));
}

static void write_control(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct usart *usart = param;
	avr->data[addr] = value;
	if (!(value & RXEN)) {
		usart->count = 0;
		usart->overrun = false;
		show_receiver(usart);
	}
	interrupts_changed(usart->interrupts); /* enabling an interrupt whose flag is up fires it */
}

/* The frame is as long as the sender makes it. */
static double frame_cycles(void *param, double frame)
{
	return frame;
}

struct receiver usart_receiver(struct usart *usart)
{
	return (struct receiver){ usart, frame_cycles, start_bit, receive };
}

void usart_reset(struct usart *usart)
{
	avr_t *avr = usart->avr;
	*usart = (struct usart){
		.avr = avr,
		.vectors = usart->vectors,
		.interrupts = usart->interrupts,
		.transmitted = usart->transmitted,
		.overruns = usart->overruns,
	};
	avr_cycle_timer_cancel(avr, sent, usart);
	avr->data[REG_UCSR0A] = UDRE;
	avr->data[REG_UCSR0B] = 0;
	avr->data[REG_UCSR0C] = 0x06;
}

void usart_attach(struct usart *usart, struct interrupts *interrupts, avr_uart_t *vectors,
                  struct serial_bytes *transmitted)
{
	avr_t *avr = interrupts->avr;
	usart->avr = avr;
	usart->vectors = vectors;
	usart->interrupts = interrupts;
	usart->transmitted = transmitted;
	hook_read(avr, REG_UDR0, read_data, usart);
	hook_write(avr, REG_UDR0, write_data, usart);
	hook_read(avr, REG_UCSR0A, NULL, NULL);
	hook_write(avr, REG_UCSR0A, write_status, usart);
	hook_read(avr, REG_UCSR0B, NULL, NULL);
	hook_write(avr, REG_UCSR0B, write_control, usart);
	hook_read(avr, REG_UBRR0L, NULL, NULL);
	hook_write(avr, REG_UBRR0L, NULL, NULL);
}
