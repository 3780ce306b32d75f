//! What the check found, for every gait: the table that `make firmware` and
//! `lizard gaits` print.

use std::fmt;

use crate::accuracy::{self, TableError};
use crate::audit::Audit;
use crate::ground::Travel;
use crate::servo::NAMES;
use lizard_core::gait::SAMPLES;
use crate::{Gait, Robot, accuracy::ALL_PHASES};

/// One gait's figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// Time of a cycle at full speed, s.
    pub period: f64,
    /// Margins, strokes and the fastest frame.
    pub audit: Audit,
    /// Of its tables, over all 65 536 phases.
    pub error: TableError,
    /// Where one cycle takes the robot, by the contact model.
    pub travel: Travel,
}

/// The figures of all gaits.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// One for each gait, in the order of the file.
    pub rows: Vec<Row>,
    /// Hash of the tables.
    pub hash: u32,
    /// How many waveforms the gaits share.
    pub waves: usize,
    /// What the waveforms and gaits take of the firmware's flash, bytes.
    pub flash: usize,
}

/// Bytes of a waveform and of a gait in flash: 128 samples of two; the place of its
/// name 3, a step of 4, and four channels of 5 (padded to 6 on the host, not there).
const WAVE_BYTES: usize = 2 * SAMPLES;
const GAIT_BYTES: usize = 3 + 4 + 4 * 5;

impl Report {
    /// Measures the tables and predicts the gaits of a robot; takes a moment.
    pub fn of(robot: &Robot) -> Self {
        let row = |(index, gait): (usize, &Gait)| Row {
            name: gait.name.clone(),
            period: gait.period,
            audit: robot.audits[index],
            error: accuracy::worst(robot, index, ALL_PHASES),
            travel: robot.predict(gait),
        };
        let (waves, gaits) = (robot.tables().waves.len(), robot.gaits.len());
        Self {
            rows: robot.gaits.iter().enumerate().map(row).collect(),
            hash: robot.tables_hash(),
            waves,
            flash: waves * WAVE_BYTES + gaits * GAIT_BYTES + robot.tables().names.len(),
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(
            f,
            "{} gaits in {} waveforms, {} bytes of flash, tables {:08x}\n",
            self.rows.len(),
            self.waves,
            self.flash,
            self.hash
        )?;
        f.write_str("              cycle      fastest  table error, deg      smallest margins       slider, mm    one cycle, mm and deg\n")?;
        f.write_str("gait              s  deg/s servo      max     rms  type-2 type-1    leg    least   most    ahead   left    turn\n")?;
        for row in &self.rows {
            let Row {
                name,
                period,
                audit,
                error,
                travel,
            } = row;
            writeln!(
                f,
                "{name:<12} {period:>6.2} {:>6.1} {:>5}   {:>6.4}  {:>6.4}  {:>6.3} {:>6.3} {:>6.3}   {:>+6.1} {:>+6.1}  {:>+7.2} {:>+6.2} {:>+7.2}",
                audit.peak.speed,
                NAMES[audit.peak.servo],
                error.max,
                error.rms,
                audit.type2.value,
                audit.type1.value,
                audit.leg.value,
                tidy(audit.stroke.0, 1),
                tidy(audit.stroke.1, 1),
                tidy(travel.forward, 2),
                tidy(travel.left, 2),
                tidy(travel.turn, 2),
            )?;
        }
        Ok(())
    }
}

/// Without the sign of a value that rounds to zero.
fn tidy(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    // Adding positive zero turns a negative one positive.
    (value * scale).round() / scale + 0.0
}
