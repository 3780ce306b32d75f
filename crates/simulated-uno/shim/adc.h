/* The ADC by the ATmega328P's data sheet, chapter 24: a supply that changes, the
 * bandgap that needs time to settle, 25 clocks for the first conversion and 13
 * for each other, and a result that is read in two halves.
 *
 * Not modelled: triggers other than free running, the noise reduction sleep,
 * the settling of a reference that is switched, more than 200 kHz.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include <simavr/avr_adc.h>

#include "instruction.h"
#include "interrupts.h"
#include "supply.h"

#define ADC_PINS 8

struct adc {
	avr_t *avr;
	const struct instruction *instruction;
	struct interrupts *interrupts;
	const struct supply *supply;
	avr_adc_t *stock;              /* simavr's, for its interrupt vector */
	uint16_t pins[ADC_PINS];       /* mV at ADC0 to ADC7 */
	double bandgap;                /* mV */
	uint64_t enabled, selected;    /* cycles at which ADEN and the channel were set */
	double before;                 /* mV of the previous channel */
	bool converting, first, locked;
	uint8_t mux, reference;        /* of the conversion in progress */
	double settled;                /* share of the bandgap's settling at its start, 0 to 1 */
	uint64_t sample_at, end;
	uint16_t sampled, result;
};

/* Sets the values at the pins and the bandgap; there is no more in the stock fidelity. */
void adc_attach(struct adc *adc, avr_t *avr);
/* Replaces simavr's handlers of its registers. */
void adc_correct(struct adc *adc, const struct instruction *instruction,
                 struct interrupts *interrupts, const struct supply *supply);
void adc_set_pin(struct adc *adc, uint8_t channel, uint16_t mv);
void adc_reset(struct adc *adc);
