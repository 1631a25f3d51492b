"""Losses whose steps are recorded on a GPU and replayed."""

from collections.abc import Callable

import torch

LossOf = Callable[..., torch.Tensor]


class Replayed:
    """The loss of batches of tensors, the same as without this class.

    A step of a small network is a thousand small pieces of work, and a GPU waits for each to be sent. Forward
    and backward are therefore recorded once for each size of a batch, and sent as a whole from then on.
    """

    def __init__(self, network: torch.nn.Module, loss_of: LossOf) -> None:
        """Of a network that stays where it is.

        Args:
            network: what is trained.
            loss_of: of the network and a batch, which it must not read on the CPU.
        """
        self._step = _Step(network, loss_of)
        self._recorded: dict[tuple[torch.Size, ...], torch.nn.Module] = {}

    def __call__(self, *batch: torch.Tensor) -> torch.Tensor:
        """The loss; its gradients reach the network's parameters, not the batch."""
        sizes = tuple(tensor.shape for tensor in batch)
        if batch[0].is_cuda and sizes not in self._recorded:
            step = _Step(self._step.network, self._step.loss_of)  # recording changes it
            self._recorded[sizes] = torch.cuda.make_graphed_callables(step, batch)
        loss: torch.Tensor = self._recorded.get(sizes, self._step)(*batch)
        return loss


class _Step(torch.nn.Module):  # type: ignore[misc] # torch is not followed, see pyproject.toml
    def __init__(self, network: torch.nn.Module, loss_of: LossOf) -> None:
        super().__init__()
        self.network, self.loss_of = network, loss_of

    def forward(self, *batch: torch.Tensor) -> torch.Tensor:
        return self.loss_of(self.network, *batch)
