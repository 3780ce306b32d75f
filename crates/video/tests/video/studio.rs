//! Records videos in a simulated studio.

use fastrand::Rng;
use lizard_contact::BodyPose;
use lizard_studio::render::{Pose, Studio, random_normal};
use lizard_studio::walk::Walk;
use lizard_video::{AnalysedVideo, Frame, Gait, Setup, Video};

/// The setup for a sheet that is printed at full scale (1:1), and a deck tag 83 mm above the floor.
pub const FULL_SCALE: Setup = Setup {
    print_scale: 1.0,
    deck_height: 83.0,
};

/// Frames per second: a low rate suffices for most tests.
pub const FRAME_RATE: f64 = 8.0;

/// Returns the studio of most tests.
pub fn studio() -> Studio {
    low_resolution_studio(5, 20.0)
}

/// Returns a random studio with a low resolution, whose camera is tilted by `camera_tilt` deg and so near that the sheet
/// fills the frame.
pub fn low_resolution_studio(seed: u64, camera_tilt: f64) -> Studio {
    let mut studio = Studio::random(&mut Rng::with_seed(seed));
    (studio.size, studio.focal_length) = ([640, 360], 1.0);
    studio.aim_camera(800.0, camera_tilt);
    studio
}

/// Adds a frame to a video.
pub fn add_frame(video: &mut Video, seconds: f64, frame: &Frame) {
    let result = video.add_frame(seconds, frame);
    result.expect("the frame fits the video");
}

/// Analyses a video of a sheet that is printed at full scale.
pub fn analyse(video: &Video) -> AnalysedVideo {
    let analysed_video = video.analyse(FULL_SCALE);
    analysed_video.expect("the video can be analysed")
}

/// Records a walk with the camera on a tripod.
pub fn record_walk(studio: &Studio, walk: &Walk, frame_rate: f64, rng: &mut Rng) -> Video {
    let pose_at = |time| walk.pose_at(time);
    record_robot(studio, walk.duration_s(), frame_rate, pose_at, rng)
}

/// Records a robot; `pose_at` returns its pose at a time, s.
pub fn record_robot(
    studio: &Studio,
    duration_s: f64,
    frame_rate: f64,
    pose_at: impl Fn(f64) -> Pose,
    rng: &mut Rng,
) -> Video {
    let background = studio.render_background(rng);
    record_frames(duration_s, frame_rate, |seconds| {
        background.render_frame(seconds, &pose_at, rng)
    })
}

/// Records frames at regular intervals; `frame_at` renders the frame at a given time, s.
pub fn record_frames(
    duration_s: f64,
    frame_rate: f64,
    mut frame_at: impl FnMut(f64) -> Frame,
) -> Video {
    let mut video = Video::default();
    for i in 0..(duration_s * frame_rate) as usize {
        let seconds = i as f64 / frame_rate;
        add_frame(&mut video, seconds, &frame_at(seconds));
    }
    video
}

/// Records a walk with a hand-held camera. The standard deviation of its position is `shake` mm, that of its angles
/// `shake / 10` deg.
pub fn record_walk_hand_held(
    studio: &Studio,
    walk: &Walk,
    frame_rate: f64,
    shake: f64,
    rng: &mut Rng,
) -> Video {
    record_frames(walk.duration_s(), frame_rate, |seconds| {
        let mut shaken_studio = studio.clone();
        shaken_studio.camera_height += shake * random_normal(rng);
        shaken_studio.aim = studio.aim.map(|value| value + shake * random_normal(rng));
        shaken_studio.camera_tilt += shake / 10.0 * random_normal(rng);
        shaken_studio.camera_roll += shake / 10.0 * random_normal(rng);
        let background = shaken_studio.render_background(rng);
        background.render_frame(seconds, |time| walk.pose_at(time), rng)
    })
}

/// Returns a gait that moves and turns `scale` times as far.
pub fn scaled_gait(gait: &Gait, scale: f64) -> Gait {
    let scale_pose = |pose: &BodyPose| BodyPose {
        forward: scale * pose.forward,
        left: scale * pose.left,
        heading: scale * pose.heading,
    };
    Gait {
        period: gait.period,
        path: gait.path.iter().map(scale_pose).collect(),
    }
}
