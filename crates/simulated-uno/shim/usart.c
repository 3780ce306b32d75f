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
/* The largest relative baud rate error at which the last sample is still inside the stop bit. */
#define BAUD_TOLERANCE 0.045

uint32_t usart_cycles_per_bit(const avr_t *avr)
{
	uint32_t ubrr = avr->data[REG_UBRR0L] | (avr->data[REG_UBRR0H] & 0x0f) << 8;
	return (ubrr + 1) * (avr->data[REG_UCSR0A] & U2X ? 8 : 16);
}

uint8_t usart_sample_byte(uint8_t byte, double ratio)
{
	uint32_t line = 1u << (DATA_BITS + 1) | (uint32_t)byte << 1; /* stop bit, data, start bit */
	uint8_t sampled = 0;
	for (int bit = 0; bit < DATA_BITS; bit++) {
		double position = (bit + 1.5) * ratio;
		if (position >= FRAME_BITS || line >> (int)position & 1)
			sampled |= 1 << bit;
	}
	return sampled;
}

/* Sets RXC, FE and DOR as the receive buffer requires. */
static void update_receive_flags(struct usart *usart)
{
	avr_t *avr = usart->interrupts->avr;
	uint8_t *status = &avr->data[REG_UCSR0A];
	*status &= ~(RXC | FE | DOR);
	if (usart->received_count && usart->received[0].has_framing_error)
		*status |= FE;
	if (usart->has_overrun)
		*status |= DOR;
	if (usart->received_count) {
		avr_raise_interrupt(avr, &usart->stock->simavr_uart->rxc); /* sets RXC */
		*status |= RXC; /* also if the interrupt was already pending */
	}
}

/* The receiver does not slow the sender down. */
static double begin_frame(void *param, double sender_frame_cycles)
{
	struct usart *usart = param;
	if (usart->received_count == RECEIVE_CAPACITY) {
		usart->received_count--; /* the next byte overwrites the shift register */
		usart->has_overrun = true;
		usart->overrun_count++;
		update_receive_flags(usart);
	}
	return sender_frame_cycles;
}

static uint8_t receive_byte(void *param, struct line_byte byte, double sender_cycles_per_bit)
{
	struct usart *usart = param;
	const avr_t *avr = usart->interrupts->avr;
	if (!(avr->data[REG_UCSR0B] & RXEN))
		return byte.value;
	double ratio = usart_cycles_per_bit(avr) / sender_cycles_per_bit;
	bool has_framing_error = byte.is_stop_bit_low || fabs(ratio - 1.0) > BAUD_TOLERANCE;
	uint8_t value = usart_sample_byte(byte.value, ratio);
	usart->received[usart->received_count++] = (struct received_byte){ value, has_framing_error };
	update_receive_flags(usart);
	return has_framing_error ? 0xff : value;
}

static uint8_t read_data(avr_t *avr, avr_io_addr_t addr, void *param)
{
	struct usart *usart = param;
	uint8_t byte = usart->received[0].value;
	if (!usart->received_count)
		return byte;
	usart->received_count--;
	for (int i = 0; i < usart->received_count; i++)
		usart->received[i] = usart->received[i + 1];
	usart->has_overrun = false;
	usart->stock->simavr_uart->rxc.pending = 0;
	interrupts_request_check(usart->interrupts);
	update_receive_flags(usart);
	avr->data[REG_UDR0] = byte;
	return byte;
}

static avr_cycle_count_t finish_frame(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct usart *usart = param;
	serial_record_push(usart->stock->transmitted, when, usart->sent_byte);
	if (usart->has_waiting_byte) {
		usart->sent_byte = usart->waiting_byte;
		usart->has_waiting_byte = false;
		avr_raise_interrupt(avr, &usart->stock->simavr_uart->udrc);
		return when + FRAME_BITS * usart_cycles_per_bit(avr);
	}
	usart->is_sending = false;
	avr_raise_interrupt(avr, &usart->stock->simavr_uart->txc);
	return 0;
}

static void write_data(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct usart *usart = param;
	if (!(avr->data[REG_UCSR0B] & TXEN) || usart->has_waiting_byte)
		return; /* the transmitter ignores the byte */
	if (!usart->is_sending) {
		usart->is_sending = true;
		usart->sent_byte = value;
		avr_cycle_timer_register(avr, FRAME_BITS * usart_cycles_per_bit(avr), finish_frame,
		                         usart);
	} else {
		usart->waiting_byte = value;
		usart->has_waiting_byte = true;
		avr->data[REG_UCSR0A] &= ~UDRE;
		usart->stock->simavr_uart->udrc.pending = 0;
	}
}

static void write_status(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct usart *usart = param;
	uint8_t *status = &avr->data[REG_UCSR0A];
	if (value & TXC) {
		*status &= ~TXC;
		usart->stock->simavr_uart->txc.pending = 0;
	}
	*status = (*status & ~(U2X | MPCM)) | (value & (U2X | MPCM));
}

static void write_control(avr_t *avr, avr_io_addr_t addr, uint8_t value, void *param)
{
	struct usart *usart = param;
	avr->data[addr] = value;
	if (!(value & RXEN)) {
		usart->received_count = 0;
		usart->has_overrun = false;
		update_receive_flags(usart);
	}
	interrupts_request_check(usart->interrupts); /* an interrupt fires if it is enabled while its flag is set */
}

struct receiver usart_receiver(struct usart *usart)
{
	return (struct receiver){ usart, begin_frame, receive_byte };
}

void usart_reset(struct usart *usart)
{
	avr_t *avr = usart->interrupts->avr;
	*usart = (struct usart){
		.stock = usart->stock,
		.interrupts = usart->interrupts,
		.overrun_count = usart->overrun_count,
	};
	avr_cycle_timer_cancel(avr, finish_frame, usart);
	avr->data[REG_UCSR0A] = UDRE;
	avr->data[REG_UCSR0B] = 0;
	avr->data[REG_UCSR0C] = 0x06;
}

void usart_attach(struct usart *usart, struct interrupts *interrupts,
                  const struct stock_uart *stock)
{
	avr_t *avr = interrupts->avr;
	usart->stock = stock;
	usart->interrupts = interrupts;
	hook_read_and_write(avr, REG_UDR0, read_data, write_data, usart);
	hook_read_and_write(avr, REG_UCSR0A, NULL, write_status, usart);
	hook_read_and_write(avr, REG_UCSR0B, NULL, write_control, usart);
	hook_read_and_write(avr, REG_UBRR0L, NULL, NULL, NULL);
}
