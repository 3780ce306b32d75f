/* USART0 of the ATmega328P by its data sheet, chapter 20.
 *
 * simavr 1.6 keeps 64 received bytes and counts 11 bits a frame, which hides
 * every overrun. Here: 10-bit frames at the rate the registers say now, two
 * received bytes and a third in the shift register, the third lost when a
 * fourth begins (DOR), and a transmit buffer of one byte.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include <simavr/avr_uart.h>

#include "interrupts.h"
#include "sender.h"
#include "list.h"

struct usart {
	avr_t *avr;
	avr_uart_t *vectors;        /* simavr's USART0, for its interrupt vectors */
	struct interrupts *interrupts;
	struct serial_bytes *transmitted;
	uint8_t fifo[2];
	bool fifo_frame_error[2];
	uint8_t held;               /* complete byte that waits in the shift register */
	bool held_frame_error;
	uint8_t count;              /* bytes in fifo, 0..2 */
	bool holding, overrun;
	uint8_t transmitting, next;
	bool busy, next_full;
	uint64_t overruns;          /* bytes lost since power-on */
};

/* Replaces simavr's handlers of USART0's registers. */
void usart_attach(struct usart *usart, struct interrupts *interrupts, avr_uart_t *vectors,
                  struct serial_bytes *transmitted);
void usart_reset(struct usart *usart);
/* The receiver for the sender's cable. */
struct receiver usart_receiver(struct usart *usart);

/* The length of a bit by the present registers. */
uint32_t usart_cycles_per_bit(const avr_t *avr);
/* The byte that a receiver reads from a sender of another rate: it samples each data bit in its
 * middle, counted from the edge of the start bit. `ratio`: length of the receiver's bit divided
 * by the sender's. The line is high after the frame, as in a pause between bytes. */
uint8_t usart_sampled(uint8_t byte, double ratio);
