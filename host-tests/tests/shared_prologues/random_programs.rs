//! Tests that random C functions compute the same results before and after the linker shrinks them.
//!
//! The functions have up to 30 bytes of arguments, of which 18 bytes fit into registers. The functions have arrays on
//! the stack and call one another while a timer interrupts them.

use std::iter;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::thread;

use fastrand::Rng;
use lizard_host_tests::avr_gcc::{compile_to_object, link, ram_address, run_to_end, shrink};
use lizard_host_tests::scaled_count;
use lizard_linker::ROUTINES;
use simulated_uno::Image;

/// The number of functions in a program. More functions would not fit into 32 KB.
const FUNCTION_COUNT: usize = 40;

/// The number of functions in a group. A function calls only functions of its own group, which limits the stack depth.
const GROUP_SIZE: usize = 5;

/// The number of programs in an ordinary run. Together they have 800 functions.
const PROGRAM_COUNT: u64 = 20;

/// The parameter types, each with the number of bytes in which an argument is passed: avr-gcc passes every argument in
/// an even number of bytes.
const TYPES: [(&str, usize); 5] = [
    ("uint8_t", 2),
    ("uint16_t", 2),
    ("uint32_t", 4),
    ("int16_t", 2),
    ("int8_t", 2),
];

/// Generates a random C expression with these variables.
fn generate_expression(rng: &mut Rng, variables: &[String], depth: u8) -> String {
    if depth > 1 || rng.u8(..4) == 0 {
        return match rng.usize(..=variables.len()) {
            index if index < variables.len() => variables[index].clone(),
            _ => format!("{}u", rng.u32(..70_000)),
        };
    }
    let [left, right] = [0; 2].map(|_| generate_expression(rng, variables, depth + 1));
    match rng.usize(..9) {
        operator @ 0..5 => format!("({left} {} {right})", ["+", "-", "^", "&", "|"][operator]),
        operator @ 5..7 => format!("({left} {} ({right} & 7))", ["<<", ">>"][operator - 5]),
        7 => format!("((uint16_t){left} * (uint16_t){right})"),
        _ => format!(
            "({left} {} {right})",
            rng.choice(["<", "==", "!="])
                .expect("the list is not empty")
        ),
    }
}

/// Generates the next function, which may call an earlier function, and adds its parameter types to `signatures`.
fn generate_function(rng: &mut Rng, signatures: &mut Vec<Vec<&'static str>>) -> String {
    let number = signatures.len();
    let (mut types, mut parameter_bytes) = (Vec::new(), 0);
    for _ in 0..rng.usize(5..11) {
        let (name, type_bytes) = TYPES[rng.usize(..TYPES.len())];
        parameter_bytes += type_bytes;
        if parameter_bytes <= 30 {
            types.push(name);
        }
    }
    let mut variables: Vec<String> = (0..types.len()).map(|index| format!("p{index}")).collect();
    let parameters = types.iter().zip(&variables);
    let parameters: Vec<String> = parameters.map(|(name, p)| format!("{name} {p}")).collect();
    let parameter_names = variables.clone();
    let [buffer_size, limit] = [rng.usize(3..30), rng.usize(..60_000)];
    let last_index = buffer_size - 1;
    variables.push("i".into());
    let fill_value = generate_expression(rng, &variables, 0);
    variables.push("sum".into());
    let [condition, subtrahend] = [0; 2].map(|_| generate_expression(rng, &variables, 0));
    variables.retain(|name| name != "i");
    let group_start = number / GROUP_SIZE * GROUP_SIZE;
    let call = if number > group_start && rng.u8(..5) > 0 {
        let callee = rng.usize(group_start..number);
        let types = signatures[callee].iter();
        let arguments =
            types.map(|name| format!("({name}){}", generate_expression(rng, &variables, 1)));
        let arguments: Vec<String> = arguments.collect();
        format!("sum ^= f{callee}({});", arguments.join(", "))
    } else {
        String::new()
    };
    let [parity_value, addend] = [0; 2].map(|_| generate_expression(rng, &parameter_names, 0));
    signatures.push(types);
    format!(
        "__attribute__((noinline, noclone)) uint16_t f{number}({parameters}) {{
            volatile uint8_t buffer[{buffer_size}]; uint8_t copy[{buffer_size}];
            uint16_t sum = 0; uint8_t flag = 0;
            for (uint8_t i = 0; i < {buffer_size}; i++) {{
                buffer[i] = {fill_value}; copy[i] = buffer[i] ^ table[i];
            }}
            asm volatile(\"\" :: \"m\"(copy));
            for (uint8_t i = 0; i < {buffer_size}; i++) {{
                sum = sum * 31 + copy[i] + buffer[{last_index} - i];
                if ({condition}) flag = !flag;
                if (flag && sum > {limit}u) sum -= {subtrahend};
            }}
            {call}
            if (!({parity_value} & 1)) sum += {addend};
            return sum ^ flag; }}\n",
        parameters = parameters.join(", "),
    )
}

/// Generates a program that calls each of its functions twice and stores the return values.
fn generate_program(rng: &mut Rng) -> String {
    let mut signatures = Vec::new();
    let functions: String = (0..FUNCTION_COUNT)
        .map(|_| generate_function(rng, &mut signatures))
        .collect();
    let mut calls = String::new();
    for call in 0..2 * FUNCTION_COUNT {
        let types = signatures[call / 2].iter();
        let arguments: Vec<String> = types.map(|_| rng.u16(..).to_string()).collect();
        let arguments = arguments.join(", ");
        calls += &format!("results[{call}] = f{}({arguments});\n", call / 2);
    }
    format!(
        "#include <avr/io.h>
        #include <avr/interrupt.h>
        #include <stdint.h>
        #pragma GCC optimize(\"{optimisation}\")
        volatile uint8_t table[32] = {{1, 2, 3, 9, 8, 7}}, done;
        volatile uint16_t ticks, results[{count}];
        ISR(TIMER0_COMPA_vect) {{ ticks++; }}
        {functions}
        int main(void) {{
            OCR0A = 130; TCCR0A = 2; TCCR0B = 1; TIMSK0 = 2; sei();
            {calls}
            cli(); done = ticks > 20;
            for (;;) {{}}
        }}",
        optimisation = rng
            .choice(["O1", "O2", "Os"])
            .expect("the list is not empty"),
        count = 2 * FUNCTION_COUNT,
    )
}

/// Runs a program and returns the two return values of each function.
fn run_and_read_return_values(image: &Image) -> Vec<[u8; 4]> {
    let results_address = ram_address(image, "results");
    let uno = run_to_end(image, 1000);
    let read_values =
        |function| [0, 1, 2, 3].map(|byte| uno.peek(results_address + 4 * function + byte));
    (0..FUNCTION_COUNT as u16).map(read_values).collect()
}

/// Finds the functions of a random program that return other values after the linker has shrunk the program. Returns
/// their numbers, and true if the linker has shrunk a function. `None` if avr-gcc fails, because it runs out of
/// registers or a branch target is too far away.
fn find_differing_functions(seed: u64) -> Option<(Vec<usize>, bool)> {
    let object = compile_to_object(&generate_program(&mut Rng::with_seed(seed))).ok()?;
    let plain_image = link("", &object).ok()?;
    let (shrunk_object, savings) = shrink(&object);
    let shrunk_image = link(ROUTINES, &shrunk_object).expect("the shrunk object links");
    let [plain_results, shrunk_results] =
        [plain_image, shrunk_image].map(|image| run_and_read_return_values(&image));
    let differing_functions =
        (0..FUNCTION_COUNT).filter(|&number| plain_results[number] != shrunk_results[number]);
    Some((differing_functions.collect(), savings.frame_bytes > 0))
}

#[test]
fn random_functions_with_stack_arguments_compute_the_same_results() {
    let seed_count = scaled_count(PROGRAM_COUNT);
    let next_seed = AtomicU64::new(0);
    let take_seed = || Some(next_seed.fetch_add(1, Relaxed)).filter(|&seed| seed < seed_count);
    let run_worker = || -> Vec<_> {
        iter::from_fn(take_seed)
            .filter_map(|seed| Some((seed, find_differing_functions(seed)?)))
            .collect()
    };
    let thread_count = thread::available_parallelism().map_or(1, usize::from);
    let compared_programs: Vec<_> = thread::scope(|scope| {
        let workers: Vec<_> = (0..thread_count).map(|_| scope.spawn(run_worker)).collect();
        let results = workers
            .into_iter()
            .map(|worker| worker.join().expect("no thread panics"));
        results.flatten().collect()
    });
    for (seed, (differing_functions, is_shrunk)) in &compared_programs {
        assert!(
            differing_functions.is_empty(),
            "program {seed}: these functions differ: {differing_functions:?}"
        );
        assert!(is_shrunk, "program {seed}: no function was shrunk");
    }
    let compiled_count = compared_programs.len() as u64;
    assert!(
        compiled_count >= seed_count * 9 / 10,
        "only {compiled_count} programs compiled"
    );
}
