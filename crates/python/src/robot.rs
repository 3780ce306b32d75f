//! A checked robot.toml, and computations on it for many poses at once.

use lizard_host::flash::image_source;
use lizard_kinematics::{Check, End, Vector};
use lizard_parts::{Assembly, Pieces, Scene};
use lizard_robot::{CheckedGait, Error, violations};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

pyo3::create_exception!(
    _lizard,
    RobotFileError,
    PyValueError,
    "An error in a robot.toml, with its `file`, `line` (None if it has no line) and `key`."
);

/// Number of columns in the result of [`Robot::solve`]: head point, tail point, coupler angles, slider directions,
/// slider strokes, margins, and 1 if the pose is safe.
const COLUMN_COUNT: usize = 2 + 2 + 4 + 2 + 2 + 10 + 1;

/// A robot whose values and gaits have been checked.
#[pyclass(frozen)]
pub struct Robot(pub lizard_robot::Robot);

/// A two-dimensional numpy array, or an error.
type Rows<'py> = PyResult<Bound<'py, PyArray2<f64>>>;

/// A gait's values for Python, as [`Robot::gait`] returns them.
type GaitValues<'py> = (
    f64,
    f64,
    (&'static str, f64),
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
);

#[pymethods]
impl Robot {
    /// Reads and checks the text of a robot.toml.
    #[new]
    fn parse(py: Python<'_>, text: &str) -> PyResult<Self> {
        wrap_robot(py, py.detach(|| lizard_robot::Robot::parse(text)))
    }

    /// Reads and checks a robot.toml file.
    #[staticmethod]
    fn load(py: Python<'_>, path: &str) -> PyResult<Self> {
        wrap_robot(py, py.detach(|| lizard_robot::Robot::load(path)))
    }

    /// Creates the same robot with only two gaits: `stand` and the gait in `table`.
    fn with_gait(&self, py: Python<'_>, table: &str) -> PyResult<Self> {
        wrap_robot(py, py.detach(|| self.0.with_gait(table)))
    }

    /// The robot's name.
    fn name(&self) -> &str {
        self.0.name()
    }

    /// The servo angles of the neutral pose, deg.
    fn neutral(&self) -> [f64; 4] {
        self.0.neutral_pose().into()
    }

    /// The limits of each servo's sweep from neutral, deg.
    fn travel(&self) -> [(f64, f64); 4] {
        self.0.servos().map(|servo| servo.travel())
    }

    /// The largest allowed servo speed of a gait, deg/s.
    fn gait_slew(&self) -> f64 {
        self.0.speed_limits().gait_slew
    }

    /// Computes the joints and margins of poses: a row of [`COLUMN_COUNT`] numbers for each row of four angles. The row
    /// of a pose without a solution is NaN, except for 0 in the last column.
    fn solve<'py>(&self, py: Python<'py>, poses: PyReadonlyArray2<'py, f64>) -> Rows<'py> {
        compute_rows(py, &poses, |angles| self.compute_row(angles))
    }

    /// Computes the matrices K (8 x 4) and K* (8 x 8) of poses: each row has the elements of K, row by row, and then
    /// the elements of K*; NaN if there is no solution.
    fn jacobians<'py>(&self, py: Python<'py>, poses: PyReadonlyArray2<'py, f64>) -> Rows<'py> {
        compute_rows(py, &poses, |angles: [f64; 4]| {
            let mut row = [f64::NAN; 96];
            if let Ok(solution) = self.0.lizard().solve(&angles.into()) {
                let (active, passive) = (solution.active_matrix(), solution.passive_matrix());
                row[..32].copy_from_slice(active.as_flattened());
                row[32..].copy_from_slice(passive.as_flattened());
            }
            row
        })
    }

    /// Computes the left and right servo angles in all four working modes from points (mm, chassis frame) of the head
    /// if `head`, otherwise of the tail; NaN where a point is out of reach.
    fn solve_inverse<'py>(
        &self,
        py: Python<'py>,
        head: bool,
        points: PyReadonlyArray2<'py, f64>,
    ) -> Rows<'py> {
        let end = if head { End::Head } else { End::Tail };
        let lizard = self.0.lizard();
        compute_rows(py, &points, |[x, y]: [f64; 2]| {
            let point = lizard.to_end(end, Vector::new(x, y));
            let Ok(modes) = lizard.end(end).inverse(point) else {
                return [f64::NAN; 8];
            };
            let angles = modes.map(|mode| [mode.theta_left, mode.theta_right]);
            core::array::from_fn(|i| end.mirror_angle(angles.as_flattened()[i]))
        })
    }

    /// Returns messages with the reasons why a pose is not safe; an empty list if it is safe.
    fn describe_violations(&self, angles: [f64; 4]) -> Vec<String> {
        match self.0.lizard().solve(&angles.into()) {
            Ok(solution) => violations::describe_pose_violations(&self.0, &solution),
            Err(infeasible) => vec![infeasible.to_string()],
        }
    }

    /// Computes the pulse widths of servo angles, us.
    fn pulses<'py>(&self, py: Python<'py>, poses: PyReadonlyArray2<'py, f64>) -> Rows<'py> {
        compute_rows(py, &poses, |angles: [f64; 4]| -> [f64; 4] {
            core::array::from_fn(|i| self.0.servos()[i].pulse(angles[i]))
        })
    }

    /// The gaits' names in the order of the file.
    fn gaits(&self) -> Vec<&str> {
        self.0.gaits().iter().map(CheckedGait::name).collect()
    }

    /// Returns a gait's period (s), its peak servo speed (deg/s), the name and value of its smallest margin, and the
    /// times (s) and servo angles (deg) of a cycle's frames.
    fn gait<'py>(&self, py: Python<'py>, name: &str) -> PyResult<GaitValues<'py>> {
        let gait = self.find_gait(name)?;
        let (times, angles): (Vec<f64>, Vec<Vec<f64>>) = gait
            .frames()
            .map(|(seconds, phase)| (seconds, gait.table_angles(phase).to_vec()))
            .unzip();
        let audit = gait.audit();
        let margins = [audit.type2, audit.type1, audit.leg].into_iter();
        let min_margin = margins.min_by(|a, b| a.value.total_cmp(&b.value));
        let min_margin = min_margin.unwrap_or(audit.leg);
        Ok((
            gait.period(),
            audit.peak_speed.speed,
            (Check::name(min_margin.check), min_margin.value),
            PyArray1::from_vec(py, times),
            PyArray2::from_vec2(py, &angles)?,
        ))
    }

    /// Predicts the movement of one cycle, with the servos in robot.toml if `with_servos`, otherwise with ideal servos:
    /// forward (mm), left (mm) and turn (deg, counter-clockwise). A component is NaN if two feet pull against the other
    /// two, so that it is undetermined.
    fn predict(&self, py: Python<'_>, name: &str, with_servos: bool) -> PyResult<[f64; 3]> {
        let gait = self.find_gait(name)?;
        let prediction = py.detach(|| {
            let prediction = self.0.predict(gait);
            if !with_servos {
                return prediction;
            }
            let (ground, motors) = (self.0.ground(), self.0.motors());
            prediction.keep_determined(gait.simulate_driven_cycle(ground, &motors, 1.0))
        });
        let components = [prediction.forward, prediction.left, prediction.turn];
        Ok(components.map(|component| component.unwrap_or(f64::NAN)))
    }

    /// Builds the robot's flash section.
    fn section<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &py.detach(|| self.0.section()))
    }

    /// Builds the image for a board as Intel HEX: the firmware with this robot, or, if `only_robot`, the robot alone.
    fn image(&self, py: Python<'_>, only_robot: bool) -> PyResult<String> {
        let image = py.detach(|| image_source::build_image(&self.0, only_robot));
        image.map(|image| image.to_hex()).map_err(to_value_error)
    }

    /// Builds the MuJoCo model as MJCF, with the parts' shapes if `shapes`. Without them, it is a fiftieth as long.
    fn mjcf(&self, py: Python<'_>, shapes: bool) -> PyResult<String> {
        py.detach(|| {
            let assembly = Assembly::new(&self.0);
            assembly.check_dimensions().map_err(to_value_error)?;
            let neutral = self.0.lizard().solve(&self.0.neutral_pose());
            let neutral = neutral.map_err(to_value_error)?;
            let scene = Scene {
                has_shapes: shapes,
                ..Scene::for_assembly(&assembly)
            };
            let pieces = Pieces::compute(&assembly, &scene).map_err(to_value_error)?;
            Ok(pieces.format_mjcf(&neutral, &scene))
        })
    }
}

impl Robot {
    /// Finds a gait by its name, or fails with the names of all gaits.
    fn find_gait(&self, name: &str) -> PyResult<&CheckedGait> {
        let gait_error = || {
            let names = self.gaits().join(", ");
            PyKeyError::new_err(format!("there is no gait {name}; the gaits are {names}"))
        };
        self.0.gait(name).ok_or_else(gait_error)
    }

    /// Computes the row of [`Robot::solve`] for one pose.
    fn compute_row(&self, angles: [f64; 4]) -> [f64; COLUMN_COUNT] {
        let mut row = [f64::NAN; COLUMN_COUNT];
        row[COLUMN_COUNT - 1] = 0.0;
        if let Ok(solution) = self.0.lizard().solve(&angles.into()) {
            let points = [solution.head_point(), solution.tail_point()];
            let points = points.map(|point| [point.x, point.y]);
            let passive = solution.passive_joints();
            let joints = [
                passive.theta2,
                passive.theta3,
                passive.theta6,
                passive.theta7,
                passive.phi_left,
                passive.phi_right,
                passive.s_left,
                passive.s_right,
            ];
            let margins = solution.margins.iter().map(|(_, value)| value);
            let is_safe = f64::from(u8::from(self.0.solve_if_allowed(angles).is_some()));
            let values = points.into_iter().flatten().chain(joints).chain(margins);
            for (cell, value) in row.iter_mut().zip(values.chain([is_safe])) {
                *cell = value;
            }
        }
        row
    }
}

/// Computes a row of `N` numbers for each row of `M` numbers.
fn compute_rows<'py, const M: usize, const N: usize>(
    py: Python<'py>,
    input: &PyReadonlyArray2<'py, f64>,
    compute: impl Fn([f64; M]) -> [f64; N],
) -> Rows<'py> {
    let input = input.as_array();
    let compute_row =
        |row: numpy::ndarray::ArrayView1<'_, f64>| compute(core::array::from_fn(|i| row[i]));
    let numbers: Vec<f64> = input.rows().into_iter().flat_map(compute_row).collect();
    PyArray1::from_vec(py, numbers).reshape([input.nrows(), N])
}

/// Wraps a robot for Python, or converts its error to a [`RobotFileError`] with the file, line and key.
fn wrap_robot(py: Python<'_>, robot: Result<lizard_robot::Robot, Error>) -> PyResult<Robot> {
    robot.map(Robot).map_err(|error| {
        let python_error = RobotFileError::new_err(error.to_string());
        let exception = python_error.value(py);
        let result = exception
            .setattr("file", &error.file)
            .and_then(|()| exception.setattr("line", error.line))
            .and_then(|()| exception.setattr("key", &error.key));
        result.err().unwrap_or(python_error)
    })
}

fn to_value_error(error: impl core::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}
