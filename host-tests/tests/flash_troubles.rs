//! The error messages of `make flash`. No board is needed, and a connected one is left alone.

use std::fs::{self, File, OpenOptions, Permissions};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;

use lizard_host_tests::root;
use lizard_time_limit::LIMIT;
use simulated_uno::Port;
use tempfile::TempDir;

/// Runs `scripts/flash --check` on the serial ports of a folder. Returns its error output, and
/// true if it succeeds. `user` is a command that runs it as another user; if it is empty, the current user runs
/// it. `port` is the value of RAVEDUDE_PORT.
fn check_as(user: &[&str], ports: &Path, port: Option<&Path>) -> (String, bool) {
    let scripts = scripts();
    let script = scripts.path().join("scripts/flash");
    let words: Vec<&str> = [user, &["bash"]].concat();
    let mut command = Command::new(words[0]);
    command.args(&words[1..]).arg(script).arg("--check");
    command.env("FLASH_DEV", ports).env_remove("RAVEDUDE_PORT");
    if let Some(port) = port {
        command.env("RAVEDUDE_PORT", port);
    }
    let output = LIMIT.output(&mut command, b"").expect("the script ends");
    let printed = String::from_utf8_lossy(&output.stderr).into_owned();
    (printed, output.status.success())
}

fn check(ports: &Path) -> (String, bool) {
    check_as(&[], ports, None)
}

/// True if the tests may run programs as another user.
fn is_root() -> bool {
    rustix::process::geteuid().is_root()
}

/// A folder that every user may read.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let all = Permissions::from_mode(0o755);
    fs::set_permissions(folder.path(), all).expect("it is ours");
    folder
}

/// A copy of the scripts that other users can read, too.
fn scripts() -> TempDir {
    let copy = folder();
    let mut command = Command::new("cp");
    command
        .arg("-r")
        .arg(root().join("scripts"))
        .arg(copy.path());
    let output = LIMIT.output(&mut command, b"").expect("cp ends");
    assert!(output.status.success(), "the scripts are copied");
    copy
}

#[test]
fn without_a_board_the_message_says_what_to_connect() {
    let (printed, goes_on) = check(folder().path());
    assert!(!goes_on);
    assert!(printed.contains("no board found"), "{printed}");
    assert!(printed.contains("cable that carries data"), "{printed}");
}

#[test]
fn the_only_board_is_used_whichever_usb_chip_it_has() {
    let ports = folder();
    File::create(ports.path().join("ttyUSB0")).expect("a file");
    assert_eq!(check(ports.path()), (String::new(), true));
}

#[test]
fn of_several_boards_one_must_be_named() {
    let ports = folder();
    for name in ["ttyACM0", "ttyUSB3"] {
        File::create(ports.path().join(name)).expect("a file");
    }
    let (printed, goes_on) = check(ports.path());
    assert!(!goes_on);
    assert!(printed.contains("several boards found"), "{printed}");
    assert!(printed.contains("make flash RAVEDUDE_PORT="), "{printed}");
    let named = ports.path().join("ttyUSB3");
    assert!(check_as(&[], ports.path(), Some(&named)).1);
}

#[test]
fn a_port_that_is_not_there_is_named() {
    let missing = Path::new("/dev/no-such-port");
    let (printed, goes_on) = check_as(&[], folder().path(), Some(missing));
    assert!(!goes_on);
    assert!(
        printed.contains("there is no /dev/no-such-port"),
        "{printed}"
    );
    assert!(printed.contains("of this machine: none"), "{printed}");
}

#[test]
fn a_port_that_another_program_has_open_names_the_program() {
    let port = Port::new().expect("a pseudo terminal");
    let ports = folder();
    symlink(port.path(), ports.path().join("ttyACM0")).expect("a link");
    assert_eq!(check(ports.path()), (String::new(), true));
    let mut options = OpenOptions::new();
    let other = options.read(true).write(true).open(port.path());
    let (printed, goes_on) = check(ports.path());
    assert!(!goes_on);
    let ours = format!("(process {})", std::process::id());
    assert!(
        printed.contains("is open in ") && printed.contains(&ours),
        "{printed}"
    );
    drop(other);
    assert!(check(ports.path()).1);
}

#[test]
fn without_permission_the_message_says_which_group_to_join() {
    let ports = folder();
    let port = ports.path().join("ttyACM0");
    File::create(&port).expect("a file");
    fs::set_permissions(&port, Permissions::from_mode(0o660)).expect("it is ours");
    let as_nobody = ["setpriv", "--reuid=nobody", "--clear-groups"];
    if !is_root() {
        // Only root can run the script as another user. A port that even its owner may not
        // open has the same effect.
        fs::set_permissions(&port, Permissions::from_mode(0o000)).expect("it is ours");
        let (printed, goes_on) = check_as(&[], ports.path(), None);
        assert!(!goes_on);
        assert!(printed.contains("may not open"), "{printed}");
        return;
    }
    let mut dialout = Command::new("chgrp");
    dialout.arg("dialout").arg(&port);
    let dialout = LIMIT.output(&mut dialout, b"").expect("chgrp ends");
    assert!(dialout.status.success(), "the group dialout is Debian's");
    let (printed, goes_on) = check_as(&as_nobody, ports.path(), None);
    assert!(!goes_on);
    assert!(printed.contains("nobody may not open"), "{printed}");
    assert!(printed.contains("usermod -aG dialout nobody"), "{printed}");
}

#[test]
fn a_missing_avrdude_says_what_to_install() {
    // A user who is not root, on a machine where no package is installed: dpkg-query finds none, and avrdude and
    // sudo are not on the PATH.
    let bin = folder();
    for tool in ["bash", "env", "id", "dirname", "grep", "apt-get"] {
        let at = Path::new("/usr/bin").join(tool);
        symlink(at, bin.path().join(tool)).expect("a link");
    }
    let no_package = bin.path().join("dpkg-query");
    // A new file: writing through a link would change the machine's own program.
    fs::write(&no_package, "#!/usr/bin/bash\nexit 1\n").expect("it is ours");
    fs::set_permissions(&no_package, Permissions::from_mode(0o755)).expect("it is ours");
    let scripts = scripts();
    let script = scripts.path().join("scripts/setup-flash");
    let mut command = if is_root() {
        let mut command = Command::new("/usr/bin/setpriv");
        command.args(["--reuid=nobody", "--clear-groups", "/usr/bin/bash"]);
        command
    } else {
        Command::new("/usr/bin/bash")
    };
    command.arg(script).env("PATH", bin.path());
    let output = LIMIT.output(&mut command, b"");
    let output = output.expect("setpriv starts (Debian package util-linux)");
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(printed.contains("setup:"), "{printed}");
    assert!(!output.status.success());
    assert!(
        printed.contains("As root, run:\n    apt-get install -y avrdude"),
        "{printed}"
    );
}
