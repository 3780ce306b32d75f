//! Tests of the error messages of `make flash`. The tests need no board and ignore any connected board.

use std::fs::{self, File, OpenOptions, Permissions};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;

use lizard_host_tests::{assert_contains, root};
use lizard_time_limit::TIME_LIMIT;
use simulated_uno::Port;
use tempfile::TempDir;

/// Runs `scripts/flash --check` on the serial ports in a folder. Returns the script's error output, as an error if the
/// script fails. `user_command` runs the script as another user, or is empty for the current user. `port` is the value
/// of RAVEDUDE_PORT.
fn check_ports_as(
    user_command: &[&str],
    port_folder: &Path,
    port: Option<&Path>,
) -> Result<String, String> {
    let scripts = copy_scripts();
    let script = scripts.path().join("scripts/flash");
    // `env` runs the command in its arguments.
    let mut command = Command::new("env");
    command.args(user_command).arg("bash").arg(script);
    command.arg("--check").env("FLASH_DEV", port_folder);
    match port {
        Some(port) => command.env("RAVEDUDE_PORT", port),
        None => command.env_remove("RAVEDUDE_PORT"),
    };
    let output = TIME_LIMIT.run_command(&mut command, b"");
    let output = output.expect("the script ends");
    let error_output = String::from_utf8_lossy(&output.stderr).into_owned();
    match output.status.success() {
        true => Ok(error_output),
        false => Err(error_output),
    }
}

/// The command that runs another command as a user other than root, from Debian's package util-linux.
const NOBODY_COMMAND: [&str; 3] = ["/usr/bin/setpriv", "--reuid=nobody", "--clear-groups"];

fn check_ports(port_folder: &Path) -> Result<String, String> {
    check_ports_as(&[], port_folder, None)
}

/// True if the tests may run programs as another user.
fn is_root() -> bool {
    rustix::process::geteuid().is_root()
}

/// Creates a folder that every user may read.
fn create_folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let permissions = Permissions::from_mode(0o755);
    fs::set_permissions(folder.path(), permissions).expect("the test owns the folder");
    folder
}

/// Copies the scripts into a folder that every user may read.
fn copy_scripts() -> TempDir {
    let copy = create_folder();
    let mut command = Command::new("cp");
    command.args(["-r", "scripts"]).arg(copy.path());
    command.current_dir(root());
    let output = TIME_LIMIT.run_command(&mut command, b"").expect("cp ends");
    assert!(output.status.success(), "cp failed");
    copy
}

#[test]
fn without_a_board_the_message_names_the_cable_to_connect() {
    let error_output = check_ports(create_folder().path()).expect_err("there is no board");
    assert_contains(&error_output, "no board found");
    assert_contains(&error_output, "cable that carries data");
}

#[test]
fn a_single_board_on_a_usb_serial_chip_is_used() {
    let port_folder = create_folder();
    File::create(port_folder.path().join("ttyUSB0")).expect("the file can be created");
    assert_eq!(check_ports(port_folder.path()), Ok(String::new()));
}

#[test]
fn with_several_boards_the_user_must_name_a_port() {
    let port_folder = create_folder();
    for name in ["ttyACM0", "ttyUSB3"] {
        File::create(port_folder.path().join(name)).expect("the file can be created");
    }
    let error_output = check_ports(port_folder.path()).expect_err("there are two boards");
    assert_contains(&error_output, "several ports may have the board");
    assert_contains(&error_output, "make flash RAVEDUDE_PORT=");
    let named_port = port_folder.path().join("ttyUSB3");
    assert!(check_ports_as(&[], port_folder.path(), Some(&named_port)).is_ok());
}

#[test]
fn a_missing_port_is_named_in_the_message() {
    let missing_port = Path::new("/dev/no-such-port");
    let error_output = check_ports_as(&[], create_folder().path(), Some(missing_port))
        .expect_err("the port does not exist");
    assert_contains(&error_output, "/dev/no-such-port does not exist");
    assert_contains(&error_output, "of this machine: none");
}

#[test]
fn the_message_names_the_program_that_has_the_port_open() {
    let port = Port::new().expect("a pseudo terminal can be opened");
    let port_folder = create_folder();
    symlink(port.path(), port_folder.path().join("ttyACM0")).expect("the link can be created");
    assert_eq!(check_ports(port_folder.path()), Ok(String::new()));
    let mut options = OpenOptions::new();
    let open_port = options.read(true).write(true).open(port.path());
    let error_output = check_ports(port_folder.path()).expect_err("the port is open");
    let own_process = format!("(process {})", std::process::id());
    assert_contains(&error_output, "is open in ");
    assert_contains(&error_output, &own_process);
    drop(open_port);
    assert!(check_ports(port_folder.path()).is_ok());
}

#[test]
fn without_permission_the_message_names_the_group_to_join() {
    let port_folder = create_folder();
    let port = port_folder.path().join("ttyACM0");
    File::create(&port).expect("the file can be created");
    fs::set_permissions(&port, Permissions::from_mode(0o660)).expect("the test owns the file");
    if !is_root() {
        // Only root can run the script as another user. A port that its owner may not open has the same effect.
        fs::set_permissions(&port, Permissions::from_mode(0o000)).expect("the test owns the file");
        let error_output = check_ports(port_folder.path()).expect_err("the port may not be opened");
        assert_contains(&error_output, "has no permission to open");
        return;
    }
    let mut chgrp = Command::new("chgrp");
    chgrp.arg("dialout").arg(&port);
    let chgrp_output = TIME_LIMIT.run_command(&mut chgrp, b"").expect("chgrp ends");
    let is_changed = chgrp_output.status.success();
    assert!(is_changed, "the group dialout does not exist");
    let error_output = check_ports_as(&NOBODY_COMMAND, port_folder.path(), None)
        .expect_err("nobody may not open the port");
    assert_contains(&error_output, "nobody has no permission to open");
    assert_contains(&error_output, "usermod -aG dialout nobody");
}

/// Runs `scripts/setup-flash` as a user other than root on a machine where avrdude, sudo and cargo are not on the PATH
/// and `dpkg_query_command` replaces `dpkg-query`. The script must fail; returns its standard output.
fn run_setup_flash(dpkg_query_command: &str) -> String {
    let bin_folder = create_folder();
    for tool in ["bash", "env", "id", "dirname", "grep", "apt-get"] {
        let tool_path = Path::new("/usr/bin").join(tool);
        symlink(tool_path, bin_folder.path().join(tool)).expect("the link can be created");
    }
    let dpkg_query = bin_folder.path().join("dpkg-query");
    // A new file instead of a link, because writing through a link would change the machine's own program.
    let dpkg_query_script = format!("#!/usr/bin/bash\n{dpkg_query_command}\n");
    fs::write(&dpkg_query, dpkg_query_script).expect("the test owns the file");
    fs::set_permissions(&dpkg_query, Permissions::from_mode(0o755))
        .expect("the test owns the file");
    let scripts = copy_scripts();
    let script = scripts.path().join("scripts/setup-flash");
    let user_command = if is_root() { &NOBODY_COMMAND[..] } else { &[] };
    let mut command = Command::new("/usr/bin/env");
    command.args(user_command).arg("/usr/bin/bash").arg(script);
    command.env("PATH", bin_folder.path());
    let output = TIME_LIMIT.run_command(&mut command, b"");
    let output = output.expect("the script ends");
    let [stdout_text, error_output] =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    // As root, the error output tells if setpriv is missing.
    assert!(
        stdout_text.contains("setup:"),
        "{stdout_text}{error_output}"
    );
    assert!(!output.status.success());
    stdout_text.into_owned()
}

#[test]
fn without_avrdude_the_message_names_the_package_to_install() {
    let instruction = "As root, run:\n    apt-get install -y avrdude";
    assert_contains(&run_setup_flash("exit 1"), instruction);
}

#[test]
fn packages_on_hold_or_for_two_architectures_count_as_installed() {
    for status in [
        "hold ok installed",
        "install ok installedinstall ok installed",
    ] {
        let stdout_text = run_setup_flash(&format!("printf '{status}'"));
        assert_contains(&stdout_text, "installing ravedude with cargo");
    }
}
