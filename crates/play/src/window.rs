//! The window to play in. One type holds an episode, what lies over its picture and the window:
//! its events touch all of them, so that they stay in one file.
//!
//! Long because keys, mouse and drawing share the state of one window.

mod blit;
mod keys;

use crate::card;
use crate::{
    Controls, Key, Overlay, Panel, PlayError, Recorder, Rival, Stage, ViewKind, Views,
    keep_episode, with_panel,
};
use hasard_engine::render::FrameSize;
use hasard_envs::EnvOptions;
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{
    DeviceEvent, DeviceId, ElementState, MouseButton, MouseScrollDelta, WindowEvent,
};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{KeyCode, PhysicalKey};
use winit::window::{CursorGrabMode, Window, WindowId};

/// What is played, and where episodes are kept.
#[derive(Clone, Debug)]
pub struct PlaySettings {
    /// Id of the environment.
    pub env: String,
    /// Its options; the size is that of the picture in the window, at first.
    pub options: EnvOptions,
    /// Draw the picture as large as the window has room.
    pub fits_window: bool,
    /// Results within the budget that an episode is held against.
    pub rivals: Vec<Rival>,
    /// Seed of the first episode; each further one is seeded one higher.
    pub seed: u64,
    /// Folder in which every finished episode is kept, or `None`.
    pub folder: Option<PathBuf>,
    /// Name of the player in those files; `human` is what reports look for.
    pub player: String,
}

/// What the keys do, for a help text.
pub const KEYS: &str = "WASD move, arrows turn and look, mouse turns (click to catch it, Esc frees it), Space jump, E use, C crouch, \
                        Shift run, Ctrl or left button attack, Q/wheel weapons, T turn round, H keys, P pause, R restart, N next, Esc quit";

/// Opens a window and lets a person play until it is closed. Gives the files of the finished
/// episodes.
///
/// # Errors
/// When the environment cannot be made, no window can be opened, or an episode cannot be kept.
pub fn play(settings: PlaySettings) -> Result<Vec<PathBuf>, PlayError> {
    let stage = Stage::new(&settings.env, &settings.options)?;
    let views = Views::new(&stage, settings.options.size, &[ViewKind::Colour])?;
    let no_window = |problem: String| {
        // The library puts its own source line in front.
        let problem = problem.rsplit(": ").next().unwrap_or_default().trim_end_matches([')', '.']);
        PlayError::Window(format!(
            "no window can be opened ({problem}); play needs a display: run it in a desktop session, or set DISPLAY"
        ))
    };
    let events = EventLoop::new().map_err(|error| no_window(error.to_string()))?;
    let mut app = App {
        seed: settings.seed,
        size: settings.options.size,
        settings,
        stage,
        views,
        controls: Controls::default(),
        recorder: None,
        paused: true,
        caught: false,
        message: "click or press Enter to begin".into(),
        card: Card::Instructions,
        overlay: Overlay::default(),
        next_tic: Instant::now(),
        surface: None,
        saved: Vec::new(),
        failure: None,
    };
    app.restart();
    app.card = Card::Instructions;
    events.run_app(&mut app).map_err(|error| no_window(error.to_string()))?;
    match app.failure {
        Some(failure) => Err(failure),
        None => Ok(app.saved),
    }
}

/// A tic lasts a thirty-fifth of a second.
const TIC: Duration = Duration::from_nanos(1_000_000_000 / 35);

type Surface = softbuffer::Surface<Rc<Window>, Rc<Window>>;

/// What lies over the picture.
enum Card {
    None,
    Instructions,
    Ending(card::Lines),
}

struct App {
    settings: PlaySettings,
    seed: u64,
    size: FrameSize,
    stage: Stage,
    views: Views,
    controls: Controls,
    recorder: Option<Recorder>,
    paused: bool,
    /// The mouse is caught by the window.
    caught: bool,
    message: String,
    card: Card,
    overlay: Overlay,
    next_tic: Instant,
    surface: Option<(Rc<Window>, Surface)>,
    saved: Vec<PathBuf>,
    failure: Option<PlayError>,
}

impl App {
    /// Begins the episode of the present seed anew.
    fn restart(&mut self) {
        self.stage.reset(self.seed);
        self.recorder = match Recorder::of(self.stage.env(), self.seed, &self.settings.player) {
            Ok(recorder) => Some(recorder),
            Err(error) => {
                self.failure = Some(error);
                None
            }
        };
        self.controls.release_all();
        self.overlay.clear();
        self.card = Card::None;
    }

    /// Goes on by a tic if it is time.
    fn advance(&mut self) -> Result<(), PlayError> {
        if self.paused || self.stage.ended() {
            return Ok(());
        }
        if self.stage.wants_action() {
            let env = self.stage.env();
            let (actions, deltas) =
                self.controls.action(env.action_space(), env.options().frame_skip);
            self.stage.act(&actions, &deltas)?;
            if let Some(recorder) = &mut self.recorder {
                recorder.push(&actions, &deltas)?;
            }
        }
        let step = self.stage.tic();
        self.overlay.tic();
        if let Some(step) = step {
            self.overlay.step(&step);
            if step.ended() {
                self.end_episode()?;
            }
        }
        Ok(())
    }

    /// Keeps the finished episode and shows how it went.
    fn end_episode(&mut self) -> Result<(), PlayError> {
        let episode = self.stage.env().episode();
        let (terminated, episode_return) = (episode.terminated, episode.episode_return);
        let mut kept = String::new();
        if let (Some(folder), Some(recorder)) = (&self.settings.folder, self.recorder.take()) {
            let path = keep_episode(folder, self.stage.env(), self.seed, recorder)?;
            kept = path.display().to_string();
            self.saved.push(path);
        }
        let panel = Panel::of(&self.stage, "");
        let rivals = &mut self.settings.rivals;
        self.card = Card::Ending(card::ending(&panel, terminated, rivals, &kept));
        if panel.cost <= panel.budget {
            rivals.push(Rival { who: format!("{} (now)", self.settings.player), episode_return });
            rivals.sort_by(|a, b| b.episode_return.total_cmp(&a.episode_return));
        }
        self.message = "Enter: next episode, R: the same again".into();
        self.catch_mouse(false);
        Ok(())
    }

    fn begin_or_resume(&mut self) {
        if self.stage.ended() {
            self.seed = self.seed.wrapping_add(1);
            self.restart();
        }
        self.paused = false;
        self.card = Card::None;
        let best = self.settings.rivals.first().map_or_else(String::new, |best| {
            format!("; best within the budget {}", crate::plain(best.episode_return))
        });
        self.message = format!("seed {}{best}; H: keys, P: pause", self.seed);
    }

    fn catch_mouse(&mut self, caught: bool) {
        let Some((window, _)) = &self.surface else { return };
        if caught {
            // Systems offer the one or the other.
            let grabbed = window
                .set_cursor_grab(CursorGrabMode::Locked)
                .or_else(|_| window.set_cursor_grab(CursorGrabMode::Confined));
            self.caught = grabbed.is_ok();
        } else {
            let _ = window.set_cursor_grab(CursorGrabMode::None);
            self.caught = false;
        }
        window.set_cursor_visible(!self.caught);
    }

    fn key(&mut self, code: KeyCode, pressed: bool, events: &ActiveEventLoop) {
        let key = keys::of(code, self.can_look());
        match (key, pressed) {
            (Some(key), true) => self.controls.press(key),
            (Some(key), false) => self.controls.release(key),
            (None, true) => match code {
                KeyCode::Enter | KeyCode::NumpadEnter => self.begin_or_resume(),
                KeyCode::KeyP if !self.stage.ended() => {
                    if self.paused {
                        self.begin_or_resume();
                    } else {
                        self.paused = true;
                        self.message = "pause; P or Enter: go on".into();
                        self.catch_mouse(false);
                    }
                }
                KeyCode::KeyH if !self.stage.ended() => {
                    if let Card::Instructions = self.card {
                        self.card = Card::None;
                    } else {
                        self.card = Card::Instructions;
                        self.paused = true;
                        self.message = "pause; Enter: go on".into();
                        self.catch_mouse(false);
                    }
                }
                KeyCode::KeyR => {
                    self.restart();
                    self.begin_or_resume();
                }
                KeyCode::KeyN => {
                    self.seed = self.seed.wrapping_add(1);
                    self.restart();
                    self.begin_or_resume();
                }
                KeyCode::Escape if self.caught => self.catch_mouse(false),
                KeyCode::Escape => events.exit(),
                _ => {}
            },
            (None, false) => {}
        }
    }

    fn can_look(&self) -> bool {
        let space = self.stage.env().action_space();
        !space.deltas.is_empty()
            || space
                .groups
                .iter()
                .any(|group| group.buttons.iter().any(|(name, _)| *name == "LOOK_UP"))
    }

    /// Draws the game in the size that the window has room for.
    fn refit(&mut self, window: PhysicalSize<u32>) -> Result<(), PlayError> {
        let size = Panel::picture_in(window.width, window.height);
        self.views = Views::new(&self.stage, size, &[ViewKind::Colour])?;
        self.size = size;
        Ok(())
    }

    /// Draws the game, what lies over it and the panel.
    fn draw(&mut self) -> Result<(), PlayError> {
        let panel = Panel::of(&self.stage, self.message.clone());
        let mut game = self.views.draw(&self.stage);
        self.overlay.draw(&mut game);
        match &self.card {
            Card::None => {}
            Card::Instructions => {
                let lines = card::instructions(&self.stage, &game);
                card::draw(&mut game, &lines);
            }
            Card::Ending(lines) => card::draw(&mut game, lines),
        }
        let picture = with_panel(&game, &panel);
        let Some((window, surface)) = &mut self.surface else { return Ok(()) };
        let size = window.inner_size();
        let (Some(width), Some(height)) =
            (NonZeroU32::new(size.width), NonZeroU32::new(size.height))
        else {
            return Ok(());
        };
        let failed = |error: softbuffer::SoftBufferError| {
            PlayError::Window(format!("the window cannot be drawn to: {error}"))
        };
        surface.resize(width, height).map_err(failed)?;
        let mut buffer = surface.buffer_mut().map_err(failed)?;
        blit::show(&picture, &mut buffer, (size.width as usize, size.height as usize));
        buffer.present().map_err(failed)
    }

    /// Ends the program's loop if something failed.
    fn check(&mut self, result: Result<(), PlayError>, events: &ActiveEventLoop) {
        if let Err(error) = result {
            self.failure = Some(error);
            events.exit();
        }
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.surface.is_some() {
            return;
        }
        // Room for a title bar and a panel of the desktop.
        let screen = events
            .primary_monitor()
            .or_else(|| events.available_monitors().next())
            .map(|monitor| monitor.size())
            .filter(|size| size.width > 0 && size.height > 0);
        if let (Some(screen), true) = (screen, self.settings.fits_window) {
            self.size = Panel::picture_in(screen.width * 19 / 20, screen.height * 9 / 10);
        }
        let width = u32::from(self.size.width);
        let height = u32::from(self.size.height) + Panel::height_under(width as usize) as u32;
        let scale = if self.settings.fits_window { 1 } else { (960 / width).max(1) };
        let attributes = Window::default_attributes()
            .with_title(format!("hasard - {}", self.settings.env))
            .with_inner_size(PhysicalSize::new(width * scale, (height + height % 2) * scale));
        let opened = (|| -> Result<(Rc<Window>, Surface), String> {
            let window =
                Rc::new(events.create_window(attributes).map_err(|error| error.to_string())?);
            let context =
                softbuffer::Context::new(Rc::clone(&window)).map_err(|error| error.to_string())?;
            let surface = softbuffer::Surface::new(&context, Rc::clone(&window))
                .map_err(|error| error.to_string())?;
            Ok((window, surface))
        })();
        match opened {
            Ok(surface) => {
                // Not every desktop says at once how large the window is.
                let size = surface.0.inner_size();
                self.surface = Some(surface);
                if self.settings.fits_window {
                    let result = self.refit(size);
                    self.check(result, events);
                }
            }
            Err(problem) => self.check(
                Err(PlayError::Window(format!("no window can be opened: {problem}"))),
                events,
            ),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) if self.settings.fits_window => {
                let result = self.refit(size);
                self.check(result, events);
            }
            WindowEvent::RedrawRequested => {
                let result = self.draw();
                self.check(result, events);
            }
            WindowEvent::Focused(false) => {
                self.controls.release_all();
                self.catch_mouse(false);
            }
            WindowEvent::KeyboardInput { event, .. } => {
                if let (PhysicalKey::Code(code), false) = (event.physical_key, event.repeat) {
                    self.key(code, event.state == ElementState::Pressed, events);
                }
            }
            WindowEvent::MouseInput { state, button, .. } => {
                let pressed = state == ElementState::Pressed;
                match button {
                    // Ending an episode needs a key: a click that was still to be a shot begins none.
                    MouseButton::Left if pressed && self.stage.ended() => {}
                    MouseButton::Left if pressed && (!self.caught || self.paused) => {
                        self.catch_mouse(true);
                        self.begin_or_resume();
                    }
                    MouseButton::Left if pressed => self.controls.press(Key::Attack),
                    MouseButton::Left => self.controls.release(Key::Attack),
                    MouseButton::Right if pressed => self.controls.press(Key::Use),
                    MouseButton::Right => self.controls.release(Key::Use),
                    _ => {}
                }
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let up = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
                    MouseScrollDelta::PixelDelta(points) => points.y,
                };
                let key = if up > 0.0 { Key::NextWeapon } else { Key::PreviousWeapon };
                self.controls.press(key);
                self.controls.release(key);
            }
            _ => {}
        }
    }

    fn device_event(&mut self, _: &ActiveEventLoop, _: DeviceId, event: DeviceEvent) {
        if let DeviceEvent::MouseMotion { delta: (right, down) } = event
            && self.caught
            && !self.paused
        {
            self.controls.move_mouse(right as f32, down as f32);
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let now = Instant::now();
        let mut drawn = false;
        while now >= self.next_tic {
            let result = self.advance();
            self.check(result, events);
            self.next_tic += TIC;
            drawn = true;
            // After a long stall (a sleeping machine) the game does not run to catch up.
            if now > self.next_tic + 10 * TIC {
                self.next_tic = now + TIC;
            }
        }
        if drawn && let Some((window, _)) = &self.surface {
            window.request_redraw();
        }
        if self.failure.is_some() {
            events.exit();
        }
        events.set_control_flow(ControlFlow::WaitUntil(self.next_tic));
    }
}
