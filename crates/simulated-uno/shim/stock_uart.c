/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stock_uart.h"

static void on_transmit(struct avr_irq_t *irq, uint32_t value, void *param)
{
	struct stock_uart *uart = param;
	uint64_t cycle = instruction_store_cycle(uart->instruction);
	serial_record_push(uart->transmitted, cycle, value);
}

/* In stock simavr, a frame has 11 bits, so it takes longer than the sender's. At the sender's true
 * rate, a long stream would overflow simavr's receive buffer of 64 bytes, so the sender sends no
 * faster than simavr receives. */
static double begin_frame(void *param, double sender_frame_cycles)
{
	const struct stock_uart *uart = param;
	double min_frame_cycles = uart->simavr_uart->cycles_per_byte;
	return min_frame_cycles < sender_frame_cycles ? sender_frame_cycles : min_frame_cycles;
}

static uint8_t receive_byte(void *param, struct line_byte byte, double cycles_per_bit)
{
	const struct stock_uart *uart = param;
	uint32_t input = byte.value | (byte.is_stop_bit_low ? UART_INPUT_FE : 0);
	avr_raise_irq(uart->simavr_uart->io.irq + UART_IRQ_INPUT, input);
	return byte.is_stop_bit_low ? 0xff : byte.value;
}

void stock_uart_attach(struct stock_uart *uart, const struct instruction *instruction,
                       struct serial_record *transmitted)
{
	avr_t *avr = instruction->avr;
	uart->simavr_uart = avr->io[AVR_DATA_TO_IO(REG_UDR0)].r.param;
	uart->instruction = instruction;
	uart->transmitted = transmitted;
	uint32_t flags = 0; /* no usleep in polling loops, no echo to stdout */
	avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
	avr_irq_register_notify(
		avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_transmit,
		uart);
}

struct receiver stock_uart_receiver(struct stock_uart *uart)
{
	return (struct receiver){ uart, begin_frame, receive_byte };
}
