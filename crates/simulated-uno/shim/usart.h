/* USART0 of the ATmega328P according to the data sheet, chapter 20.
 *
 * simavr 1.6 keeps 64 received bytes and uses 11 bits for a frame, so an overrun never happens. Here
 * a frame has 10 bits at the rate that the registers currently set. Two received bytes wait in the
 * buffer and a third byte in the shift register; the third byte is lost when a fourth begins (DOR).
 * The transmitter has a buffer of one byte.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include "interrupts.h"
#include "stock_uart.h"

#define RECEIVE_CAPACITY 3 /* bytes: two in the buffer, one in the shift register */

struct usart {
	/* simavr's USART0, for its interrupt vectors and the record of the transmitted bytes. */
	const struct stock_uart *stock;
	struct interrupts *interrupts;
	struct received_byte { uint8_t value; bool has_framing_error; } received[RECEIVE_CAPACITY];
	uint8_t received_count;           /* number of bytes in `received` */
	bool has_overrun;                 /* DOR: a byte was lost after UDR0 was last read */
	uint8_t sent_byte;                /* byte in the transmit shift register */
	uint8_t waiting_byte;             /* byte in the transmit buffer */
	bool is_sending;                  /* the transmit shift register is in use */
	bool has_waiting_byte;            /* the transmit buffer is full */
	uint64_t overrun_count;           /* number of bytes lost so far; survives resets */
};

/* Replaces simavr's callbacks for USART0's registers. */
void usart_attach(struct usart *usart, struct interrupts *interrupts,
                  const struct stock_uart *stock);
void usart_reset(struct usart *usart);
/* Returns the USART as the receiver at the end of the sender's cable. */
struct receiver usart_receiver(struct usart *usart);

/* The length of a bit, cycles, as the registers currently set it. */
uint32_t usart_cycles_per_bit(const avr_t *avr);
/* Returns the byte that a receiver reads from a sender with another baud rate. The receiver samples
 * the line in the middle of each of its own data bits, counted from the edge of the start bit.
 * `ratio`: length of the receiver's bit divided by the length of the sender's bit. After the frame
 * the line is high, as in a pause between bytes. */
uint8_t usart_sample_byte(uint8_t byte, double ratio);
