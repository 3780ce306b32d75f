/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "adc.h"

#include <math.h>

enum { /* ADCSRA */
	ADEN = 1 << 7, ADSC = 1 << 6, ADATE = 1 << 5, ADIF = 1 << 4, ADIE = 1 << 3, ADPS = 7,
};
enum { /* ADMUX */
	REFS = 3 << 6, ADLAR = 1 << 5, MUX = 15,
	REFERENCE_AVCC = 1 << 6, REFERENCE_BANDGAP = 3 << 6,
	TEMPERATURE = 8, BANDGAP = 14,
};

#define NOMINAL_BANDGAP_MV 1100.0
#define ROOM_TEMPERATURE_MV 314.0 /* output of the temperature sensor at 25 deg C (table 24-2) */
#define SETTLING_CYCLES (70 * CHIP_CYCLES_PER_US) /* longest start-up of the bandgap (29.5) */

/* Times from the start of a conversion to its sample and to its end, in half ADC clocks
 * (table 24-1). Index 1 is the first conversion after ADEN was set, index 0 each later one. */
static const unsigned sample_half_clocks[2] = { 3, 27 };
static const unsigned length_half_clocks[2] = { 26, 50 };

static uint64_t cycles_per_clock(const avr_t *avr)
{
	unsigned select = avr->data[REG_ADCSRA] & ADPS;
	return 1u << (select ? select : 1);
}

static double channel_mv(const struct adc *adc, uint8_t mux)
{
	if (mux < ADC_PIN_COUNT)
		return adc->pin_mv[mux];
	return mux == BANDGAP ? adc->bandgap_mv : mux == TEMPERATURE ? ROOM_TEMPERATURE_MV : 0.0;
}

/* "If not stabilized, the first value read after the first conversion may be wrong" (24.4):
 * here the input changes linearly from the previous channel's voltage to the bandgap. */
static double input_mv(const struct adc *adc)
{
	double mv = channel_mv(adc, adc->mux);
	return adc->mux == BANDGAP
	       ? adc->previous_mv + (mv - adc->previous_mv) * adc->settled_fraction
	       : mv;
}

static avr_cycle_count_t sample(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct adc *adc = param;
	double reference = 0.0; /* nothing is connected to AREF */
	if (adc->reference == REFERENCE_AVCC)
		reference = supply_mv(adc->supply, when);
	else if (adc->reference == REFERENCE_BANDGAP)
		reference = adc->bandgap_mv;
	double code = reference > 0.0 ? input_mv(adc) * 1024.0 / reference : 1023.0;
	adc->sampled_code = code < 1023.0 ? (uint16_t)code : 1023;
	return 0;
}

static void begin_conversion(struct adc *adc, uint64_t edge);

static avr_cycle_count_t finish_conversion(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct adc *adc = param;
	uint8_t *control = &avr->data[REG_ADCSRA];
	if (!adc->is_result_locked)
		adc->result = adc->sampled_code;
	*control &= ~ADSC;
	avr_raise_interrupt(avr, &adc->stock->adc);
	if (*control & ADATE)
		begin_conversion(adc, when); /* free-running mode */
	return 0;
}

static void stop_conversion(struct adc *adc)
{
	adc->next_is_first = true;
	avr_cycle_timer_cancel(adc->avr, sample, adc);
	avr_cycle_timer_cancel(adc->avr, finish_conversion, adc);
}

static void begin_conversion(struct adc *adc, uint64_t edge)
{
	avr_t *avr = adc->avr;
	uint64_t clock_cycles = cycles_per_clock(avr);
	uint64_t ready_at = adc->enabled_at > adc->selected_at ? adc->enabled_at : adc->selected_at;
	uint64_t waited_cycles = edge > ready_at ? edge - ready_at : 0;
	adc->settled_fraction = fmin((double)waited_cycles / SETTLING_CYCLES, 1.0);
	adc->mux = avr->data[REG_ADMUX] & MUX;
	adc->reference = avr->data[REG_ADMUX] & REFS;
	avr->data[REG_ADCSRA] |= ADSC;
	uint64_t sample_at = edge + sample_half_clocks[adc->next_is_first] * clock_cycles / 2;
	uint64_t end_at = edge + length_half_clocks[adc->next_is_first] * clock_cycles / 2;
	adc->next_is_first = false;
	chip_call_at(avr, sample_at, sample, adc);
	chip_call_at(avr, end_at, finish_conversion, adc);
}

/* "The conversion starts at the following rising edge of the ADC clock cycle";
 * the prescaler "starts counting from the moment the ADC is switched on" (24.4). */
static uint64_t next_edge(const struct adc *adc, uint64_t cycle)
{
	uint64_t clock_cycles = cycles_per_clock(adc->avr);
	return adc->enabled_at + ((cycle - adc->enabled_at) / clock_cycles + 1) * clock_cycles;
}

static void write_control(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct adc *adc = param;
	uint64_t cycle = instruction_store_cycle(adc->interrupts->instruction);
	uint8_t old = avr->data[address];
	uint8_t control = value & (ADEN | ADATE | ADIE | ADPS);
	control |= (old & ADIF & ~value) | (old & ADSC);
	if (!(control & ADEN)) {
		stop_conversion(adc);
		control &= ~ADSC;
	} else if (!(old & ADEN)) {
		adc->enabled_at = cycle;
	}
	avr->data[address] = control;
	if (!(control & ADIF))
		adc->stock->adc.pending = 0; /* a conversion that ends in this cycle sets ADIF again */
	if ((control & ADEN) && (value & ADSC) && !(control & ADSC))
		begin_conversion(adc, next_edge(adc, cycle));
	interrupts_request_check(adc->interrupts);
}

static void write_channel(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct adc *adc = param;
	uint8_t old = avr->data[address] & MUX;
	if (old != (value & MUX)) {
		adc->previous_mv = channel_mv(adc, old);
		adc->selected_at = instruction_store_cycle(adc->interrupts->instruction);
	}
	avr->data[address] = value & (REFS | ADLAR | MUX);
}

static uint8_t read_result(avr_t *avr, avr_io_addr_t address, void *param)
{
	struct adc *adc = param;
	uint16_t shown_result = avr->data[REG_ADMUX] & ADLAR ? adc->result << 6 : adc->result;
	/* "When ADCL is read, the ADC Data Register is not updated until ADCH is
	 * read" (24.9.3). */
	adc->is_result_locked = address == REG_ADCL;
	return adc->is_result_locked ? shown_result : shown_result >> 8;
}

static void ignore_write(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
}

void adc_attach(struct adc *adc, avr_t *avr)
{
	*adc = (struct adc){
		.avr = avr,
		.stock = (avr_adc_t *)chip_find_peripheral(avr, "adc"),
		.bandgap_mv = NOMINAL_BANDGAP_MV,
		.next_is_first = true,
	};
}

void adc_correct(struct adc *adc, struct interrupts *interrupts, const struct supply *supply)
{
	avr_t *avr = adc->avr;
	adc->interrupts = interrupts;
	adc->supply = supply;
	hook_read_and_write(avr, REG_ADCSRA, NULL, write_control, adc);
	hook_read_and_write(avr, REG_ADMUX, NULL, write_channel, adc);
	hook_read_and_write(avr, REG_ADCL, read_result, ignore_write, adc);
	hook_read_and_write(avr, REG_ADCH, read_result, ignore_write, adc);
}

void adc_set_pin_mv(struct adc *adc, uint8_t pin, uint16_t mv)
{
	adc->pin_mv[pin % ADC_PIN_COUNT] = mv;
	avr_raise_irq(adc->stock->io.irq + ADC_IRQ_ADC0 + pin % ADC_PIN_COUNT, mv);
}

void adc_reset(struct adc *adc)
{
	stop_conversion(adc);
	adc->is_result_locked = false;
	adc->result = 0;
	adc->enabled_at = adc->selected_at = 0;
	adc->previous_mv = adc->pin_mv[0];
}
