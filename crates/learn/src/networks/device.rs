//! Where networks are computed, chosen at run time.

#[cfg(feature = "graphics")]
use burn::tensor::Device;

use hasard_engine::simd::Simd;

use crate::config::{Products, TrainConfig};
use crate::error::LearnError;

/// A place to compute.
#[derive(Clone, Debug)]
pub enum ComputeDevice {
    /// The processor, with the kernels of [`crate::networks::cpu`].
    Processor(Simd),
    /// A device of the `burn` crate.
    #[cfg(feature = "graphics")]
    Burn(Device),
}

impl ComputeDevice {
    /// The device that a run's settings name, with the kernels that they ask for.
    ///
    /// # Errors
    /// As [`ComputeDevice::named`].
    pub fn of(config: &TrainConfig) -> Result<ComputeDevice, LearnError> {
        match ComputeDevice::named(&config.device)? {
            ComputeDevice::Processor(_) if config.learning.portable => {
                Ok(ComputeDevice::Processor(Simd::PLAIN))
            }
            ComputeDevice::Processor(simd) => {
                with_products(simd, config.learning.products).map(ComputeDevice::Processor)
            }
            #[cfg(feature = "graphics")]
            card => Ok(card),
        }
    }

    /// The processor with the plain kernels, whose bits are those of every machine.
    #[must_use]
    pub fn plain() -> ComputeDevice {
        ComputeDevice::Processor(Simd::PLAIN)
    }

    /// The kernels that compute what is on the processor: everything, or what comes before and
    /// after the networks.
    #[must_use]
    pub fn kernels(&self) -> Simd {
        match self {
            ComputeDevice::Processor(kernels) => *kernels,
            #[cfg(feature = "graphics")]
            ComputeDevice::Burn(_) => Simd::widest(),
        }
    }

    /// The same in float32, if its products are rounded; `None` if they are not.
    #[must_use]
    pub fn unrounded(&self) -> Option<ComputeDevice> {
        let rounds = !self.is_card() && self.kernels().family().rounds();
        rounds.then(|| ComputeDevice::Processor(Simd::widest()))
    }

    /// Whether it is a device of its own, beside the processor.
    #[must_use]
    pub fn is_card(&self) -> bool {
        !matches!(self, ComputeDevice::Processor(_))
    }

    /// The device of a name: `cpu`; with the cargo features of the same names `vulkan`, `cuda` and
    /// `wgpu` (Metal, Direct3D or Vulkan, whatever there is), with a colon and a number for another
    /// than the first; and, with any of them, `flex` (burn's processor backend, for comparison).
    ///
    /// # Errors
    /// When the name is unknown, the program was built without the device, or this machine has none
    /// of that number.
    pub fn named(name: &str) -> Result<ComputeDevice, LearnError> {
        let (kind, number) = name.split_once(':').unwrap_or((name, "0"));
        if kind == "cpu" && name != kind {
            let why = format!("device '{name}': the processor has no number; write cpu");
            return Err(LearnError::Config(why));
        }
        let number: usize = number.parse().map_err(|_| {
            LearnError::Config(format!(
                "device '{name}' has no number after the colon; write {kind}:0"
            ))
        })?;
        match kind {
            "cpu" => Ok(ComputeDevice::Processor(
                Simd::chosen().map_err(|error| LearnError::Config(error.to_string()))?,
            )),
            "vulkan" | "cuda" | "wgpu" | "flex" => card(kind, name, number),
            _ => Err(LearnError::Config(format!(
                "device '{name}' is unknown; use one of cpu, vulkan, cuda, wgpu"
            ))),
        }
    }
}

/// The chosen family, or the one that multiplies as a run's settings say: a run keeps to its own.
fn with_products(chosen: Simd, products: Products) -> Result<Simd, LearnError> {
    let rounds = |simd: Simd| simd.family().rounds();
    let refuse =
        |why: String| Err(LearnError::Config(format!("learning.products is bfloat16, but {why}")));
    match products {
        Products::Float32 if rounds(chosen) => Ok(Simd::widest()),
        Products::Float32 => Ok(chosen),
        Products::Bfloat16 => match (Simd::bfloat16().pop(), Simd::forced()) {
            (None, _) => {
                refuse("this processor has no AVX512-BF16; train on one that has it, or begin a run with float32".into())
            }
            (Some(_), Ok(Some(forced))) if !rounds(forced) => refuse(format!("HASARD_SIMD is {forced}; leave it out")),
            (Some(_), Ok(Some(forced))) => Ok(forced),
            (Some(fastest), _) => Ok(fastest),
        },
    }
}

fn not_built_in(kind: &str) -> LearnError {
    let feature = if kind == "flex" { "vulkan" } else { kind };
    LearnError::Config(format!(
        "this program was built without {kind}; build it with `--features {feature}`, or use --device cpu"
    ))
}

#[cfg(not(feature = "graphics"))]
fn card(kind: &str, _name: &str, _number: usize) -> Result<ComputeDevice, LearnError> {
    Err(not_built_in(kind))
}

/// A card of a kind, counted from 0.
#[cfg(feature = "graphics")]
fn card(kind: &str, name: &str, number: usize) -> Result<ComputeDevice, LearnError> {
    let all = cards(kind).ok_or_else(|| not_built_in(kind))?;
    let there = match all.len() {
        0 => "no such card, or no driver for one".to_string(),
        1 => "only number 0".to_string(),
        count => format!("only numbers 0 to {}", count - 1),
    };
    all.into_iter().nth(number).map(ComputeDevice::Burn).ok_or_else(|| {
        LearnError::Config(format!(
            "device '{name}' was not found: this machine has {there}; use another, or --device cpu"
        ))
    })
}

/// All cards of a kind on this machine, those of their own before built-in ones. `None` if this
/// program was built without the kind.
#[cfg(feature = "graphics")]
fn cards(kind: &str) -> Option<Vec<Device>> {
    match kind {
        "flex" => Some(vec![Device::flex()]),
        #[cfg(feature = "vulkan")]
        "vulkan" => {
            // Drivers that compute on the processor crash on these kernels (llvmpipe) or return
            // other numbers (SwiftShader); `wgpu` works on them.
            let processor = Device::vulkan(burn::tensor::DeviceKind::Cpu);
            let all = Device::enumerate(burn::tensor::DeviceType::Vulkan).into_vec();
            Some(all.into_iter().filter(|device| *device != processor).collect())
        }
        #[cfg(feature = "wgpu")]
        "wgpu" => Some(Device::enumerate(burn::tensor::DeviceType::Wgpu).into_vec()),
        #[cfg(feature = "cuda")]
        "cuda" => Some(Device::enumerate(burn::tensor::DeviceType::Cuda).into_vec()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run keeps to the products that its settings name, whatever is chosen otherwise, and is
    /// refused where there are none.
    #[test]
    fn runs_keep_to_their_products() {
        for simd in Simd::available() {
            assert_eq!(with_products(simd, Products::Float32).unwrap(), simd);
        }
        match Simd::bfloat16().pop() {
            None => {
                let refused =
                    with_products(Simd::PLAIN, Products::Bfloat16).unwrap_err().to_string();
                assert!(refused.contains("no AVX512-BF16"), "{refused}");
            }
            Some(rounding) => {
                assert_eq!(with_products(rounding, Products::Float32).unwrap(), Simd::widest());
                match Simd::forced().unwrap() {
                    Some(forced) if !forced.family().rounds() => {
                        let refused =
                            with_products(forced, Products::Bfloat16).unwrap_err().to_string();
                        assert!(refused.contains("leave it out"), "{refused}");
                    }
                    forced => assert_eq!(
                        with_products(Simd::widest(), Products::Bfloat16).unwrap(),
                        forced.unwrap_or(rounding)
                    ),
                }
            }
        }
    }

    #[test]
    fn the_processor_is_always_there_and_unknown_devices_are_refused() {
        assert!(matches!(ComputeDevice::named("cpu"), Ok(ComputeDevice::Processor(_))));
        #[cfg(feature = "graphics")]
        assert!(matches!(ComputeDevice::named("flex"), Ok(ComputeDevice::Burn(_))));
        for bad in ["tpu", "cuda:x", ""] {
            assert!(ComputeDevice::named(bad).is_err(), "{bad}");
        }
        // A machine may have one card, but not so many.
        #[cfg(feature = "vulkan")]
        assert!(
            ComputeDevice::named("vulkan:999").unwrap_err().to_string().contains("was not found")
        );
        #[cfg(not(feature = "cuda"))]
        assert!(ComputeDevice::named("cuda").unwrap_err().to_string().contains("--features cuda"));
    }
}
