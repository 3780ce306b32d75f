//! Renders a video of a gait with a known displacement, for the page's tests. Writes FOLDER/video.y4m, which a browser
//! uses as its camera, the same frames in FOLDER/frames, and in FOLDER/truth.json the gait's displacement per cycle,
//! from which each cycle in the video deviates slightly.
//!
//! `studio FOLDER WIDTH CYCLES [COVERED_TAG]...`: WIDTH is in pixels. The robot walks CYCLES cycles of the paper's
//! `walk` and rests before and after them. Each COVERED_TAG is the id of a tag that is covered.

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use fastrand::Rng;
use lizard_studio::encode_jpeg;
use lizard_studio::render::Studio;
use lizard_studio::walk::{Variation, Walk, paper_gait, true_displacement};

/// Frames per second. Chromium shows a late frame at the right time if its delay is shorter than the frame interval,
/// so a low rate is reliable on a busy machine.
const FRAMES_PER_S: u32 = 10;
/// The value of both chroma planes of a grey frame.
const NEUTRAL_CHROMA: u8 = 128;
/// Standard deviations of a cycle's displacement from the gait's: mm forward, mm to the left, rad.
const CYCLE_DEVIATION: [f64; 3] = [0.1, 0.1, 0.002];
/// Quality of the JPEG frames, 1 to 100.
const JPEG_QUALITY: u8 = 85;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let usage = "usage: studio FOLDER WIDTH CYCLES [COVERED_TAG]...";
    let mut next_argument = || arguments.next().ok_or(usage);
    let folder = PathBuf::from(next_argument()?);
    let width: usize = next_argument()?.parse()?;
    let cycle_count: usize = next_argument()?.parse()?;
    let rng = &mut Rng::with_seed(4);
    let mut studio = Studio::random(rng);
    (studio.size, studio.focal_length) = ([width, width * 9 / 16], 0.95);
    studio.aim_camera(800.0, 15.0);
    studio.deck_tag_height = 95.0;
    studio.covered_tags = arguments.map(|id| id.parse()).collect::<Result<_, _>>()?;
    let gait = paper_gait("walk");
    let truth = true_displacement(&gait);
    let start = -truth.forward * cycle_count as f64 / 2.0;
    let variation = Variation {
        cycle_deviation: CYCLE_DEVIATION,
        ..Variation::default()
    };
    let walk = Walk::new(&gait, [start, 0.0, 0.0], cycle_count, variation, rng);
    let background = studio.render_background(rng);
    let frames_folder = folder.join("frames");
    fs::create_dir_all(&frames_folder)?;
    let [video_width, video_height] = studio.size;
    let header =
        format!("YUV4MPEG2 W{video_width} H{video_height} F{FRAMES_PER_S}:1 Ip A1:1 C420jpeg\n");
    let mut video = header.into_bytes();
    for i in 0..(walk.duration_s() * f64::from(FRAMES_PER_S)) as usize {
        let seconds = i as f64 / f64::from(FRAMES_PER_S);
        let frame = background.render_frame(seconds, |time| walk.pose_at(time), rng);
        let jpeg = encode_jpeg(&frame, JPEG_QUALITY)?;
        fs::write(frames_folder.join(format!("{seconds:.4}s.jpg")), jpeg)?;
        video.extend(b"FRAME\n");
        video.extend(frame.grey());
        video.resize(video.len() + video_width * video_height / 2, NEUTRAL_CHROMA);
    }
    fs::write(folder.join("video.y4m"), video)?;
    let (forward, left, turn) = (truth.forward, truth.left, truth.turn);
    let truth_json = format!("{{\"forward\":{forward},\"left\":{left},\"turn\":{turn}}}\n");
    Ok(fs::write(folder.join("truth.json"), truth_json)?)
}
