//! The error of the firmware's tables relative to the gaits in floating point.

use lizard_core::numbers::units::CYCLE16;

use crate::gaits::Gait;
use crate::tables::Tables;

/// The error of a gait's tables over a cycle, relative to the gait in floating point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TableError {
    /// Largest error over all servos, deg.
    pub max: f64,
    /// Root mean square of the errors of all servos, deg.
    pub rms: f64,
    /// Index of the servo with the largest error, 0 to 3.
    pub servo: usize,
    /// Phase of the largest error, 0 to 1.
    pub phase: f64,
}

/// Number of phases that the firmware distinguishes in a cycle.
pub(crate) const PHASE_COUNT: usize = CYCLE16 as usize;

/// Computes the table error of the gait with this index over `phase_count` evenly spaced phases, where `phase_count`
/// divides [`PHASE_COUNT`].
pub(crate) fn compute_table_error(
    gait: &Gait,
    index: usize,
    tables: &Tables,
    phase_count: usize,
) -> TableError {
    let mut error = TableError::default();
    let mut sum_of_squares = 0.0;
    for i in 0..phase_count {
        let table_phase = (i * (PHASE_COUNT / phase_count)) as u16;
        let phase = f64::from(table_phase) / PHASE_COUNT as f64;
        let table_angles = gait.angles_from_table(tables.sweeps(index, table_phase));
        let exact_angles = gait.angles(phase);
        for servo in 0..4 {
            let deviation = (table_angles[servo] - exact_angles[servo]).abs();
            sum_of_squares += deviation * deviation;
            if deviation > error.max {
                error = TableError {
                    max: deviation,
                    servo,
                    phase,
                    ..error
                };
            }
        }
    }
    error.rms = (sum_of_squares / (4 * phase_count) as f64).sqrt();
    error
}

#[cfg(test)]
mod tests {
    use crate::testing::for_each_gait;

    #[test]
    fn the_maximum_error_covers_all_servos() {
        const SAMPLE_COUNT: usize = 1024;
        for_each_gait(|label, _, gait| {
            let mut errors = [0.0f64; 4];
            for i in 0..SAMPLE_COUNT {
                let table_angles = gait.table_angles((64 * i) as u16);
                let exact_angles = gait.angles(i as f64 / SAMPLE_COUNT as f64);
                for servo in 0..4 {
                    let error = (table_angles[servo] - exact_angles[servo]).abs();
                    errors[servo] = errors[servo].max(error);
                }
            }
            let table_error = gait.table_error_over(SAMPLE_COUNT);
            let max_error = errors.into_iter().fold(0.0, f64::max);
            assert_eq!(table_error.max, max_error, "{label}");
            assert_eq!(errors[table_error.servo], max_error);
            assert!(table_error.rms <= max_error);
            assert!(2.0 * table_error.rms >= max_error / SAMPLE_COUNT as f64);
        });
    }
}
