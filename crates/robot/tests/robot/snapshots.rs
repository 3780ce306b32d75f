//! Snapshots of the gait tables of the paper's robot, which show a changed gait as a diff.

use std::fmt::Write;

use lizard_robot::CheckedGait;

use crate::paper;

/// The folder of the snapshots.
const SNAPSHOT_DIR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots");
/// Number of phases in a snapshot.
const ROW_COUNT: u32 = 64;

/// Formats a gait as a CSV table: the phase in cycles, and the four servo angles in the firmware's tables, deg.
fn format_csv(gait: &CheckedGait) -> String {
    let mut text = "phase,A1,A2,A3,A4\n".to_string();
    for row in 0..ROW_COUNT {
        let [a1, a2, a3, a4] = gait.table_angles((row * (65536 / ROW_COUNT)) as u16);
        let phase = f64::from(row) / f64::from(ROW_COUNT);
        writeln!(text, "{phase:.6},{a1:.2},{a2:.2},{a3:.2},{a4:.2}")
            .expect("writing to a String cannot fail");
    }
    text
}

#[test]
fn every_gait_matches_its_snapshot() {
    let should_update = std::env::var_os("BLESS_GAITS").is_some();
    for gait in paper().gaits() {
        let path = format!("{SNAPSHOT_DIR}/{}.csv", gait.name());
        let current = format_csv(gait);
        if should_update {
            std::fs::write(&path, &current).expect(&path);
        }
        let stored = std::fs::read_to_string(&path).unwrap_or_default();
        let mut lines = stored.lines().zip(current.lines());
        if let Some((stored, current)) = lines.find(|(stored, current)| stored != current) {
            panic!(
                "{} has changed.\n  was {stored}\n  is  {current}\nIf this is intended, run BLESS_GAITS=1 cargo test -p lizard-robot snapshots and commit {path}.",
                gait.name()
            );
        }
        assert_eq!(
            stored.lines().count(),
            current.lines().count(),
            "{path} and the gait have different numbers of rows. If this is intended, run with BLESS_GAITS=1."
        );
    }
}

#[test]
fn every_snapshot_belongs_to_a_gait() {
    let robot = paper();
    for entry in std::fs::read_dir(SNAPSHOT_DIR).expect(SNAPSHOT_DIR) {
        let name = entry.expect(SNAPSHOT_DIR).file_name();
        let name = name.to_string_lossy();
        let gait_name = name
            .strip_suffix(".csv")
            .unwrap_or_else(|| panic!("{SNAPSHOT_DIR}/{name} is not a snapshot"));
        let has_gait = robot.gait(gait_name).is_some();
        assert!(has_gait, "{SNAPSHOT_DIR}/{name} belongs to no gait");
    }
}
