/* The ADC according to the ATmega328P's data sheet, chapter 24. AVCC, the usual reference, may
 * change; the bandgap needs time to settle; the first conversion takes 25 ADC clocks and each later
 * one 13; reading a result's low byte locks the result until the high byte is read.
 *
 * Not modelled: triggers other than free running, the sleep mode ADC Noise Reduction, the settling
 * of the reference after a switch, the errors caused by an ADC clock above 200 kHz.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#pragma once

#include <simavr/avr_adc.h>

#include "interrupts.h"
#include "supply.h"

#define ADC_PIN_COUNT 8

struct adc {
	avr_t *avr;
	struct interrupts *interrupts;
	const struct supply *supply;
	avr_adc_t *stock;               /* simavr's ADC, for its interrupt vector */
	uint16_t pin_mv[ADC_PIN_COUNT]; /* voltages at ADC0 to ADC7 */
	double bandgap_mv;
	uint64_t enabled_at;            /* cycle at which ADEN was set */
	uint64_t selected_at;           /* cycle at which the channel was last changed */
	double previous_mv;             /* voltage of the previously selected channel */
	bool next_is_first;             /* the next conversion is the first one since ADEN was set */
	bool is_result_locked;          /* ADCL has been read, but not yet ADCH */
	uint8_t mux;                    /* channel of the conversion in progress */
	uint8_t reference;              /* REFS bits of the conversion in progress */
	double settled_fraction;        /* settling of the bandgap when the conversion began, 0 to 1 */
	uint16_t sampled_code;          /* result of the conversion in progress, once sampled */
	uint16_t result;                /* contents of the ADC Data Register, right adjusted */
};

/* Finds simavr's ADC, which adc_set_pin_mv needs. The stock fidelity needs nothing else. */
void adc_attach(struct adc *adc, avr_t *avr);
/* Replaces simavr's callbacks for the ADC's registers. */
void adc_correct(struct adc *adc, struct interrupts *interrupts, const struct supply *supply);
/* Sets the voltage at the pin ADC0 + `pin` % 8. */
void adc_set_pin_mv(struct adc *adc, uint8_t pin, uint16_t mv);
void adc_reset(struct adc *adc);
