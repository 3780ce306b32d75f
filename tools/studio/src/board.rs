//! Simulation of a board that is lifted until the robot on it slides, with static and sliding friction.

use std::f64::consts::PI;

use fastrand::Rng;
use lizard_video::Frame;

use crate::render::Studio;

/// Acceleration of gravity, mm/s^2.
const GRAVITY_MM_S2: f64 = 9806.65;
/// Time step of the simulation, s.
const STEP_S: f64 = 0.0005;
/// Distance downhill after which the user stops the robot, mm.
const STOP_DISTANCE_MM: f64 = 110.0;

/// A board that is lifted, with a robot on it.
#[derive(Clone, Copy)]
pub struct LiftedBoard {
    /// Coefficient of static friction.
    pub static_friction: f64,
    /// Coefficient of sliding friction.
    pub sliding_friction: f64,
    /// Speed of the lift, deg/s.
    pub lift_deg_per_s: f64,
    /// Time at which the lift begins, s.
    pub lift_start_s: f64,
    /// Tilt before the lift, deg.
    pub start_tilt_deg: f64,
    /// Tilt at which the lift ends, deg.
    pub end_tilt_deg: f64,
    /// Direction of the robot's head, relative to downhill, deg.
    pub head_direction_deg: f64,
    /// Direction in which the robot slides, relative to downhill, deg.
    pub slide_direction_deg: f64,
}

/// A board that is lifted evenly. Its robot faces downhill and slides straight down.
pub const EVENLY_LIFTED_BOARD: LiftedBoard = LiftedBoard {
    static_friction: 0.75,
    sliding_friction: 0.68,
    lift_deg_per_s: 6.0,
    lift_start_s: 1.2,
    start_tilt_deg: 0.0,
    end_tilt_deg: 50.0,
    head_direction_deg: 0.0,
    slide_direction_deg: 0.0,
};

impl LiftedBoard {
    /// Returns the board's tilt at a time, deg.
    fn tilt_deg_at(&self, seconds: f64) -> f64 {
        (self.start_tilt_deg + self.lift_deg_per_s * (seconds - self.lift_start_s).max(0.0))
            .min(self.end_tilt_deg)
    }

    /// Returns the robot's distance downhill, mm, at every [`STEP_S`] up to a time in seconds.
    fn slide_distances(&self, seconds: f64) -> Vec<f64> {
        let (mut distance_mm, mut speed_mm_s) = (0.0, 0.0);
        let advance = |step: usize| {
            let tilt_deg = self.tilt_deg_at(step as f64 * STEP_S);
            let (sin, cos) = tilt_deg.to_radians().sin_cos();
            let friction = match speed_mm_s > 0.0 {
                true => self.sliding_friction,
                false => self.static_friction,
            };
            let new_speed_mm_s = speed_mm_s + GRAVITY_MM_S2 * (sin - friction * cos) * STEP_S;
            speed_mm_s = f64::max(0.0, new_speed_mm_s);
            distance_mm = f64::min(STOP_DISTANCE_MM, distance_mm + speed_mm_s * STEP_S);
            distance_mm
        };
        (0..(seconds / STEP_S) as usize).map(advance).collect()
    }

    /// Records the board and passes each frame with its time to `use_frame`. The full frame rate is used only around
    /// the slide.
    pub fn record(
        &self,
        studio: &Studio,
        frames_per_s: f64,
        mut use_frame: impl FnMut(f64, &Frame),
    ) {
        let mut rng = Rng::with_seed(11);
        let duration_s = self.lift_start_s
            + (self.end_tilt_deg.min(45.0) - self.start_tilt_deg) / self.lift_deg_per_s
            + 0.5;
        let distances_mm = self.slide_distances(duration_s);
        let distance_mm_at = |seconds: f64| {
            distances_mm[((seconds.max(0.0) / STEP_S) as usize).min(distances_mm.len() - 1)]
        };
        let mut seconds = 0.0;
        while seconds < duration_s && distance_mm_at(seconds - 0.1) < STOP_DISTANCE_MM {
            let mut tilted_studio = studio.clone();
            tilted_studio.board_tilt = self.tilt_deg_at(seconds);
            // Downhill is to the left in the scene.
            let heading = PI + self.head_direction_deg.to_radians();
            let (sin, cos) = (PI + self.slide_direction_deg.to_radians()).sin_cos();
            let pose_at = |time: f64| {
                let distance_mm = distance_mm_at(time);
                [55.0 + distance_mm * cos, 5.0 + distance_mm * sin, heading]
            };
            let background = tilted_studio.render_background(&mut rng);
            let frame = background.render_frame(seconds, pose_at, &mut rng);
            use_frame(seconds, &frame);
            seconds += match distance_mm_at(seconds + 0.25) > 0.5 {
                true => 1.0 / frames_per_s,
                false => 0.2,
            };
        }
    }
}

/// Returns a studio with few pixels, in which the sheet fills the frame.
pub fn small_studio() -> Studio {
    let mut studio = Studio::random(&mut Rng::with_seed(5));
    (studio.size, studio.focal_length) = ([640, 480], 0.85);
    studio.aim_camera(850.0, 12.0);
    // A robot that is not aligned with the strips needs more room between them.
    studio.strips = [[5.0, -180.0, 0.03], [-5.0, 180.0, PI - 0.02]];
    studio.exposure_s = 1.0 / 250.0;
    studio
}
