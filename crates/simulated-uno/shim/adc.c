/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "adc.h"

enum { /* ADCSRA */
	ADEN = 1 << 7, ADSC = 1 << 6, ADATE = 1 << 5, ADIF = 1 << 4, ADIE = 1 << 3, ADPS = 7,
};
enum { /* ADMUX */
	REFS = 3 << 6, ADLAR = 1 << 5, MUX = 15,
	REFERENCE_AVCC = 1 << 6, REFERENCE_BANDGAP = 3 << 6,
	TEMPERATURE = 8, BANDGAP = 14,
};

#define NOMINAL_BANDGAP 1100.0
#define ROOM_TEMPERATURE 314.0 /* mV of its sensor at 25 deg C (table 24-2) */
#define SETTLING (70 * CHIP_CYCLES_PER_US) /* tBG, the longest (29.5) */

/* Table 24-1, in halves of an ADC clock. */
static const unsigned sample_halves[2] = { 3, 27 }; /* others, first */
static const unsigned length_halves[2] = { 26, 50 };

static uint64_t clock_cycles(const avr_t *avr)
{
	unsigned select = avr->data[REG_ADCSRA] & ADPS;
	return 1u << (select ? select : 1);
}

static double channel_mv(const struct adc *adc, uint8_t mux)
{
	if (mux < ADC_PINS)
		return adc->pins[mux];
	return mux == BANDGAP ? adc->bandgap : mux == TEMPERATURE ? ROOM_TEMPERATURE : 0.0;
}

/* "If not stabilized, the first value read after the first conversion may be
 * wrong" (24.4): here it lies on a line from the channel before to the bandgap. */
static double input_mv(const struct adc *adc)
{
	double mv = channel_mv(adc, adc->mux);
	return adc->mux == BANDGAP ? adc->before + (mv - adc->before) * adc->settled : mv;
}

static avr_cycle_count_t sample(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct adc *adc = param;
	double reference = 0.0; /* AREF: nothing is connected */
	if (adc->reference == REFERENCE_AVCC)
		reference = supply_mv(adc->supply, when);
	else if (adc->reference == REFERENCE_BANDGAP)
		reference = adc->bandgap;
	double code = reference > 0.0 ? input_mv(adc) * 1024.0 / reference : 1023.0;
	adc->sampled = code < 1023.0 ? (uint16_t)code : 1023;
	return 0;
}

static void begin(struct adc *adc, uint64_t edge);

static avr_cycle_count_t finish(avr_t *avr, avr_cycle_count_t when, void *param)
{
	struct adc *adc = param;
	uint8_t *control = &avr->data[REG_ADCSRA];
	adc->converting = false;
	if (!adc->locked)
		adc->result = adc->sampled;
	*control &= ~ADSC;
	avr_raise_interrupt(avr, &adc->stock->adc);
	if (*control & ADATE)
		begin(adc, when); /* free running */
	return 0;
}

static void arm_timers(struct adc *adc)
{
	avr_t *avr = adc->avr;
	avr_cycle_timer_register(avr, chip_cycles_until(avr, adc->sample_at), sample, adc);
	avr_cycle_timer_register(avr, chip_cycles_until(avr, adc->end), finish, adc);
}

static void stop(struct adc *adc)
{
	adc->converting = false;
	adc->first = true;
	avr_cycle_timer_cancel(adc->avr, sample, adc);
	avr_cycle_timer_cancel(adc->avr, finish, adc);
}

static void begin(struct adc *adc, uint64_t edge)
{
	avr_t *avr = adc->avr;
	uint64_t clock = clock_cycles(avr);
	uint64_t ready = adc->enabled > adc->selected ? adc->enabled : adc->selected;
	uint64_t waited = edge > ready ? edge - ready : 0;
	adc->settled = waited < SETTLING ? (double)waited / SETTLING : 1.0;
	adc->mux = avr->data[REG_ADMUX] & MUX;
	adc->reference = avr->data[REG_ADMUX] & REFS;
	adc->converting = true;
	avr->data[REG_ADCSRA] |= ADSC;
	adc->sample_at = edge + sample_halves[adc->first] * clock / 2;
	adc->end = edge + length_halves[adc->first] * clock / 2;
	adc->first = false;
	arm_timers(adc);
}

/* "The conversion starts at the following rising edge of the ADC clock cycle";
 * the prescaler "starts counting from the moment the ADC is switched on" (24.4). */
static uint64_t next_edge(const struct adc *adc, uint64_t cycle)
{
	uint64_t clock = clock_cycles(adc->avr);
	return adc->enabled + ((cycle - adc->enabled) / clock + 1) * clock;
}

static void write_control(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct adc *adc = param;
	uint64_t cycle = instruction_effect_cycle(adc->instruction);
	uint8_t old = avr->data[address];
	uint8_t control = value & (ADEN | ADATE | ADIE | ADPS);
	control |= old & ADIF & ~value;
	control |= adc->converting ? ADSC : 0;
	if (!(control & ADEN)) {
		stop(adc);
		control &= ~ADSC;
	} else if (!(old & ADEN)) {
		adc->enabled = cycle;
	}
	avr->data[address] = control;
	if (!(control & ADIF))
		adc->stock->adc.pending = 0; /* a conversion that ends in this cycle counts */
	if ((control & ADEN) && (value & ADSC) && !adc->converting)
		begin(adc, next_edge(adc, cycle));
	interrupts_changed(adc->interrupts);
}

static void write_channel(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
	struct adc *adc = param;
	uint8_t old = avr->data[address] & MUX;
	if (old != (value & MUX)) {
		adc->before = channel_mv(adc, old);
		adc->selected = instruction_effect_cycle(adc->instruction);
	}
	avr->data[address] = value & (REFS | ADLAR | MUX);
}

static uint8_t read_result(avr_t *avr, avr_io_addr_t address, void *param)
{
	struct adc *adc = param;
	uint16_t shown = avr->data[REG_ADMUX] & ADLAR ? adc->result << 6 : adc->result;
	/* "When ADCL is read, the ADC Data Register is not updated until ADCH is
	 * read" (24.9.3). */
	adc->locked = address == REG_ADCL;
	return adc->locked ? shown : shown >> 8;
}

static void write_nothing(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
}

void adc_attach(struct adc *adc, avr_t *avr)
{
	*adc = (struct adc){
		.avr = avr,
		.stock = (avr_adc_t *)chip_part(avr, "adc"),
		.bandgap = NOMINAL_BANDGAP,
		.first = true,
	};
}

void adc_correct(struct adc *adc, const struct instruction *instruction,
                 struct interrupts *interrupts, const struct supply *supply)
{
	avr_t *avr = adc->avr;
	adc->instruction = instruction;
	adc->interrupts = interrupts;
	adc->supply = supply;
	hook_write(avr, REG_ADCSRA, write_control, adc);
	hook_read(avr, REG_ADCSRA, NULL, NULL);
	hook_write(avr, REG_ADMUX, write_channel, adc);
	hook_read(avr, REG_ADMUX, NULL, NULL);
	const uint16_t data[2] = { REG_ADCL, REG_ADCH };
	for (int i = 0; i < 2; i++) {
		hook_read(avr, data[i], read_result, adc);
		hook_write(avr, data[i], write_nothing, adc);
	}
}

void adc_set_pin(struct adc *adc, uint8_t channel, uint16_t mv)
{
	adc->pins[channel % ADC_PINS] = mv;
	avr_raise_irq(adc->stock->io.irq + ADC_IRQ_ADC0 + channel % ADC_PINS, mv);
}

void adc_reset(struct adc *adc)
{
	stop(adc);
	adc->locked = false;
	adc->result = 0;
	adc->enabled = adc->selected = 0;
	adc->before = adc->pins[0];
}
