//! Test that random C functions compute the same before and after the linker rewrites them.
//!
//! The functions have up to 30 bytes of arguments, of which 18 fit into registers. Their arrays lie on
//! the stack, they call one another, and a timer interrupts them.

use std::iter;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::thread;

use fastrand::Rng;
use lizard_host_tests::avr_gcc::{compile_to_object, link};
use lizard_host_tests::scaled;
use lizard_linker::{ROUTINES, shrink};
use simulated_uno::{Fidelity, Image, Uno};

use crate::address;

/// Number of functions of one program, as many as 32 KB hold.
const FUNCTIONS: usize = 40;

/// Number of functions in a group. A function calls only others of its group, so that the stack suffices.
const GROUP: usize = 5;

/// Number of programs in an ordinary run; together they have 800 functions.
const PROGRAMS: u64 = 20;

/// Types of arguments, and the bytes of registers that an argument of each type takes.
const TYPES: [(&str, usize); 5] = [
    ("uint8_t", 2),
    ("uint16_t", 2),
    ("uint32_t", 4),
    ("int16_t", 2),
    ("int8_t", 2),
];

/// Returns a random expression of these variables.
fn random_expression(random: &mut Rng, names: &[String], depth: u8) -> String {
    if depth > 1 || random.u8(..4) == 0 {
        return match random.usize(..=names.len()) {
            index if index < names.len() => names[index].clone(),
            _ => format!("{}u", random.u32(..70_000)),
        };
    }
    let [a, b] = [0; 2].map(|_| random_expression(random, names, depth + 1));
    match random.usize(..9) {
        operator @ 0..5 => format!("({a} {} {b})", ["+", "-", "^", "&", "|"][operator]),
        operator @ 5..7 => format!("({a} {} ({b} & 7))", ["<<", ">>"][operator - 5]),
        7 => format!("((uint16_t){a} * (uint16_t){b})"),
        _ => format!("({a} {} {b})", random.choice(["<", "==", "!="]).unwrap()),
    }
}

/// Writes the next function, which may call an earlier one, and adds its argument types to `signatures`.
fn random_function(random: &mut Rng, signatures: &mut Vec<Vec<&'static str>>) -> String {
    let number = signatures.len();
    let (mut types, mut bytes) = (Vec::new(), 0);
    for _ in 0..random.usize(5..11) {
        let (name, size) = TYPES[random.usize(..TYPES.len())];
        bytes += size;
        if bytes <= 30 {
            types.push(name);
        }
    }
    let parameters = types.iter().enumerate();
    let parameters: Vec<String> = parameters
        .map(|(index, name)| format!("{name} p{index}"))
        .collect();
    let mut names: Vec<String> = (0..types.len()).map(|index| format!("p{index}")).collect();
    let arguments = names.clone();
    let [room_size, limit] = [random.usize(3..30), random.usize(..60_000)];
    let last_index = room_size - 1;
    names.push("i".into());
    let fill_value = random_expression(random, &names, 0);
    names.push("sum".into());
    let [condition, subtrahend] = [0; 2].map(|_| random_expression(random, &names, 0));
    names.retain(|name| name != "i");
    let group_start = number / GROUP * GROUP;
    let call = if number > group_start && random.u8(..5) > 0 {
        let callee = random.usize(group_start..number);
        let values = signatures[callee].iter();
        let values = values.map(|name| format!("({name}){}", random_expression(random, &names, 1)));
        let values: Vec<String> = values.collect();
        format!("sum ^= f{callee}({});", values.join(", "))
    } else {
        String::new()
    };
    let [odd_test, addend] = [0; 2].map(|_| random_expression(random, &arguments, 0));
    signatures.push(types);
    format!(
        "__attribute__((noinline, noclone)) uint16_t f{number}({parameters}) {{
            volatile uint8_t room[{room_size}]; uint8_t copy[{room_size}];
            uint16_t sum = 0; uint8_t flag = 0;
            for (uint8_t i = 0; i < {room_size}; i++) {{
                room[i] = {fill_value}; copy[i] = room[i] ^ table[i];
            }}
            asm volatile(\"\" :: \"m\"(copy));
            for (uint8_t i = 0; i < {room_size}; i++) {{
                sum = sum * 31 + copy[i] + room[{last_index} - i];
                if ({condition}) flag = !flag;
                if (flag && sum > {limit}u) sum -= {subtrahend};
            }}
            {call}
            if (!({odd_test} & 1)) sum += {addend};
            return sum ^ flag; }}\n",
        parameters = parameters.join(", "),
    )
}

/// Returns a program that calls each of its functions twice and stores the return values.
fn random_program(random: &mut Rng) -> String {
    let mut signatures = Vec::new();
    let functions: String = (0..FUNCTIONS)
        .map(|_| random_function(random, &mut signatures))
        .collect();
    let mut calls = String::new();
    for call in 0..2 * FUNCTIONS {
        let values = signatures[call / 2].iter();
        let values: Vec<String> = values.map(|_| random.u16(..).to_string()).collect();
        let values = values.join(", ");
        calls += &format!("results[{call}] = f{}({values});\n", call / 2);
    }
    format!(
        "#include <avr/io.h>
        #include <avr/interrupt.h>
        #include <stdint.h>
        #pragma GCC optimize(\"{level}\")
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
        level = random.choice(["O1", "O2", "Os"]).unwrap(),
        count = 2 * FUNCTIONS,
    )
}

/// Runs a program and returns the two return values of each function.
fn run_for_results(image: &Image) -> Vec<[u8; 4]> {
    let [done_address, results_address] = ["done", "results"].map(|name| address(image, name));
    let mut uno = Uno::with_image(image.clone(), Fidelity::DataSheet);
    for _ in 0..200 {
        uno.run_ms(5);
        if uno.peek(done_address) == 1 {
            break;
        }
    }
    assert_eq!(
        uno.peek(done_address),
        1,
        "it came to its end, interrupted often"
    );
    let values_of =
        |function| [0, 1, 2, 3].map(|byte| uno.peek(results_address + 4 * function + byte));
    (0..FUNCTIONS as u16).map(values_of).collect()
}

/// Returns the functions of a program that return another value after the linker has rewritten it, and true if
/// the linker has rewritten any function. `None` if avr-gcc fails because it runs out of registers or a branch
/// is too far.
fn differences(seed: u64) -> Option<(Vec<usize>, bool)> {
    let object = compile_to_object(&random_program(&mut Rng::with_seed(seed))).ok()?;
    let plain_image = link("", &object).ok()?;
    let (object, savings) = shrink(&object)
        .expect("it is an object")
        .expect("of an AVR");
    let shrunk_image = link(ROUTINES, &object).expect("it links as before");
    let [plain_results, shrunk_results] = [
        run_for_results(&plain_image),
        run_for_results(&shrunk_image),
    ];
    let differing =
        (0..FUNCTIONS).filter(|&number| plain_results[number] != shrunk_results[number]);
    Some((differing.collect(), savings.frames > 0))
}

#[test]
fn random_functions_with_arguments_on_the_stack_compute_the_same() {
    let seeds = scaled(PROGRAMS);
    let next_seed = AtomicU64::new(0);
    let claim = || Some(next_seed.fetch_add(1, Relaxed)).filter(|&seed| seed < seeds);
    let run_share = || -> Vec<_> {
        iter::from_fn(claim)
            .filter_map(|seed| Some((seed, differences(seed)?)))
            .collect()
    };
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let tried_programs: Vec<_> = thread::scope(|scope| {
        let shares: Vec<_> = (0..cores).map(|_| scope.spawn(run_share)).collect();
        let finished = shares.into_iter().map(|share| share.join());
        finished
            .flat_map(|result| result.expect("no thread panics"))
            .collect()
    });
    for (seed, (differing, is_rewritten)) in &tried_programs {
        assert!(differing.is_empty(), "of program {seed}: {differing:?}");
        assert!(is_rewritten, "program {seed} has frames to share");
    }
    assert!(
        tried_programs.len() as u64 >= seeds * 9 / 10,
        "{}",
        tried_programs.len()
    );
}
