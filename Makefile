# Everything goes through these. What they need is installed without asking; what cannot be is named.

.DEFAULT_GOAL := help
.PHONY: help demo test fuzz clean

help: ## This list
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "  make %-6s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

demo: ## Build Snell, render the default scene, say where the picture is
	@scripts/demo.sh

test: ## Everything that CI runs
	@scripts/test.sh

fuzz: ## Fuzz every reader for a minute each (SECONDS_EACH=600 make fuzz for longer)
	@scripts/fuzz.sh

clean: ## Remove what was built
	cargo clean
	rm -rf .venv out fuzz/target
