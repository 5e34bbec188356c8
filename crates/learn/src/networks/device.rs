//! Where networks are computed, chosen at run time.

#[cfg(feature = "graphics")]
use burn::tensor::Device;

use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::networks::cpu::simd::Kernels;

/// A place to compute.
#[derive(Clone, Debug)]
pub enum ComputeDevice {
    /// The processor, with the kernels of [`crate::networks::cpu`].
    Processor(Kernels),
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
            ComputeDevice::Processor(_) if config.learning.portable => Ok(ComputeDevice::Processor(Kernels::PORTABLE)),
            device => Ok(device),
        }
    }

    /// The processor with the plain kernels, whose bits are those of every machine.
    #[must_use]
    pub fn plain() -> ComputeDevice {
        ComputeDevice::Processor(Kernels::PORTABLE)
    }

    /// The kernels that compute what is on the processor: everything, or what comes before and after the networks.
    #[must_use]
    pub fn kernels(&self) -> Kernels {
        match self {
            ComputeDevice::Processor(kernels) => *kernels,
            #[cfg(feature = "graphics")]
            ComputeDevice::Burn(_) => Kernels::available()[0],
        }
    }

    /// The device of a name: `cpu`; with the cargo features of the same names `vulkan`, `cuda` and `wgpu` (Metal, Direct3D or
    /// Vulkan, whatever there is), with a colon and a number for another than the first; and, with any of them, `flex`
    /// (burn's processor backend, for comparison).
    ///
    /// # Errors
    /// When the name is unknown, the program was built without the device, or this machine has none of that number.
    pub fn named(name: &str) -> Result<ComputeDevice, LearnError> {
        let (kind, number) = name.split_once(':').unwrap_or((name, "0"));
        let number: usize = number
            .parse()
            .map_err(|_| LearnError::Config(format!("device '{name}' has no number after the colon; write {kind}:0")))?;
        match kind {
            "cpu" => Ok(ComputeDevice::Processor(Kernels::chosen()?)),
            "vulkan" | "cuda" | "wgpu" | "flex" => card(kind, name, number),
            _ => Err(LearnError::Config(format!("device '{name}' is unknown; use one of cpu, vulkan, cuda, wgpu"))),
        }
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
        LearnError::Config(format!("device '{name}' was not found: this machine has {there}; use another, or --device cpu"))
    })
}

/// All cards of a kind on this machine, those of their own before built-in ones. `None` if this program was built without the
/// kind.
#[cfg(feature = "graphics")]
fn cards(kind: &str) -> Option<Vec<Device>> {
    match kind {
        "flex" => Some(vec![Device::flex()]),
        #[cfg(feature = "vulkan")]
        "vulkan" => {
            // Drivers that compute on the processor crash on these kernels (llvmpipe) or return other numbers (SwiftShader);
            // `wgpu` works on them.
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
        assert!(ComputeDevice::named("vulkan:999").unwrap_err().to_string().contains("was not found"));
        #[cfg(not(feature = "cuda"))]
        assert!(ComputeDevice::named("cuda").unwrap_err().to_string().contains("--features cuda"));
    }
}
