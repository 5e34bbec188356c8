use super::*;
use crate::config::numbers::check_number;
use crate::config::{AlgorithmKind, EnvConfig, Preset};

fn plain(algorithm: AlgorithmKind, preset: Preset) -> TrainConfig {
    TrainConfig::new(algorithm, preset, EnvConfig::new("RemedyRushLevel1-v0")).unwrap()
}

fn answer(setting: &str) -> Result<(), String> {
    let config = plain(AlgorithmKind::PpoPid, Preset::Quick);
    let check = config.with(setting).and_then(|config| config.check());
    check.map_err(|error| error.to_string())
}

/// Each of them began a run that could only fail, or learn nothing.
#[test]
fn numbers_out_of_range_are_refused_by_name() {
    for setting in [
        "learning.value_coefficient=-1",
        "learning.muon_scale=-0.5",
        "learning.adam_epsilon=0",
        "learning.adam_epsilon=1e-300",
        "learning.adam_betas=[1,0.9]",
        "learning.adam_betas=[0.9,-0.1]",
        "algorithm_settings.pid_gains=[-1,0,0]",
        "algorithm_settings.pid_gains=[0,-1,0]",
        "algorithm_settings.pid_gains=[0,0,1e300]",
        "algorithm_settings.pid_initial=-1",
        "algorithm_settings.multiplier_initial=-1",
        "algorithm_settings.multiplier_initial=1e300",
        "algorithm_settings.saute_unsafe_reward=-1e300",
        "algorithm_settings.trust_radius=0",
        "algorithm_settings.fisher_damping=-1",
        "algorithm_settings.line_search_factor=0",
        "algorithm_settings.line_search_factor=1",
        "algorithm_settings.focops_eta=-1",
        "algorithm_settings.focops_temperature=0",
        "algorithm_settings.saute_gamma=0",
        "algorithm_settings.saute_gamma=1.5",
        "algorithm_settings.saute_horizon=0",
        "evaluation.candidates=0",
    ] {
        let message = answer(setting).unwrap_err();
        let name = setting.split('=').next().unwrap();
        assert!(message.contains(&format!("{name} cannot be ")), "{setting}: {message}");
        assert!(message.len() < 120 && !message.contains('\n'), "{setting}: {message}");
    }
    // The loss became NaN, and a lower rate was advised.
    let saute = plain(AlgorithmKind::PpoSaute, Preset::Quick).with("budget_share=0").unwrap();
    assert!(saute.check().unwrap_err().to_string().contains("budget_share of PPOSaute"));
    let message = answer("algorithm_settings.multiplier_rate=1e300").unwrap_err();
    assert_eq!(
        message,
        "the rate of the multiplier cannot be 1e300; it must be a number from 0 to 1e9"
    );
}

#[test]
fn numbers_that_pages_name_are_allowed() {
    for setting in [
        "algorithm_settings.pid_gains=[1.5,0.2,0]",
        "algorithm_settings.pid_initial=1.5",
        "algorithm_settings.multiplier_initial=2.8",
        "algorithm_settings.saute_unsafe_reward=-0.5",
        "algorithm_settings.saute_gamma=1",
        "learning.adam_betas=[0,0.999]",
        "learning.value_coefficient=0",
        "evaluation.candidates=3",
    ] {
        answer(setting).unwrap();
    }
    for &algorithm in AlgorithmKind::ALL {
        for &preset in Preset::ALL {
            plain(algorithm, preset).check().unwrap();
        }
    }
}

/// A range without an upper end was said to end at a number of 309 digits.
#[test]
fn ranges_and_numbers_are_short() {
    let message = answer("learning.clip_value=-1").unwrap_err();
    assert_eq!(message, "the value clip cannot be -1; it must be a number of at least 0");
    for (number, text) in
        [(1e300, "1e300"), (-2.5e-9, "-2.5e-9"), (0.0, "0"), (0.0001, "0.0001"), (1e6, "1000000")]
    {
        assert_eq!(Shown(number).to_string(), text);
    }
    let message = check_number("--safety-budget 'nan'", f64::NAN).unwrap_err().to_string();
    assert!(message.starts_with("--safety-budget 'nan' cannot be NaN"), "{message}");
}
