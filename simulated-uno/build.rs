//! Compiles the C shim against Debian's libsimavr and links both.

fn main() {
    let parts = [
        "adc",
        "boot",
        "call_timer",
        "chip",
        "chip_access",
        "eeprom",
        "disturbance",
        "handlers",
        "hook",
        "instruction",
        "interrupts",
        "list",
        "pin_toggle",
        "recorder",
        "reset",
        "restart",
        "sender",
        "serial_bytes",
        "stock_uart",
        "supply",
        "timer1",
        "uno",
        "usart",
        "watchdog",
    ];
    println!("cargo:rerun-if-changed=shim");
    let compiled = cc::Build::new()
        .files(parts.map(|part| format!("shim/{part}.c")))
        .opt_level(2)
        .std("gnu11")
        .warnings(true)
        .extra_warnings(true)
        .try_compile("simulated_uno_shim");
    if let Err(error) = compiled {
        panic!(
            "the shim does not compile; it needs libsimavr's headers:\n\
             sudo apt-get install libsimavr-dev libelf-dev\n{error}"
        );
    }
    println!("cargo:rustc-link-lib=simavr");
    println!("cargo:rustc-link-lib=elf");
    println!("cargo:rustc-link-lib=m");
}
